//! Makes the mesh of `scenes/marble/figure.pbrt`: a veiled head on a plinth, as a binary PLY file. The same at every call.
//!
//! ```text
//! cargo run -p tyndall-formats --example make_figure -- scenes/marble
//! ```

mod figure;
mod nets;
mod solids;

use std::{fs::File, io::BufWriter, path::Path};

use tyndall_formats::mesh::write_ply;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1).ok_or("name the directory to write to")?;
    let mesh = nets::surface(figure::distance, &figure::planes());
    write_ply(&mesh, &mut BufWriter::new(File::create(Path::new(&directory).join("figure.ply"))?))?;
    Ok(())
}
