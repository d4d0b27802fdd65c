//! Shows the image in a running tev viewer (<https://github.com/Tom94/tev>) while it is being rendered.

use std::{
    net::{TcpStream, ToSocketAddrs},
    time::Duration,
};

use anyhow::Context;
use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};
use tyndall::film::Film;

/// A viewer that does not answer must not hold up the render.
const PATIENCE: Duration = Duration::from_secs(2);

const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// A connection to a viewer.
#[derive(Debug)]
pub(crate) struct Tev {
    client: TevClient,
    name: String,
    created: bool,
}

impl Tev {
    /// Connects to the viewer at `host:port`; the image will be called `name` there.
    pub(crate) fn connect(address: &str, name: &str) -> anyhow::Result<Self> {
        let socket = connect(address).with_context(|| format!("no tev viewer at {address}"))?;
        Ok(Self { client: TevClient::wrap(socket), name: name.to_owned(), created: false })
    }

    /// Shows the film as it is now.
    pub(crate) fn show(&mut self, film: &Film) -> anyhow::Result<()> {
        if film.pixels.is_empty() {
            return Ok(());
        }
        if !self.created {
            self.create(film).context("tev does not take the image")?;
        }
        self.update(film).context("tev does not take the image any more")
    }

    fn create(&mut self, film: &Film) -> std::io::Result<()> {
        self.client.send(PacketCreateImage {
            image_name: &self.name,
            grab_focus: false,
            width: film.width,
            height: film.height,
            channel_names: &CHANNELS,
        })?;
        self.created = true;
        Ok(())
    }

    fn update(&mut self, film: &Film) -> std::io::Result<()> {
        let data: Vec<f32> = film.pixels.iter().flat_map(tyndall::film::Pixel::mean).collect();
        self.client.send(PacketUpdateImage {
            image_name: &self.name,
            grab_focus: false,
            channel_names: &CHANNELS,
            channel_offsets: &[0, 1, 2],
            channel_strides: &[3, 3, 3],
            x: film.crop.min.0,
            y: film.crop.min.1,
            width: film.crop.width(),
            height: film.crop.height(),
            data: &data,
        })
    }
}

fn connect(address: &str) -> std::io::Result<TcpStream> {
    let mut last = std::io::Error::from(std::io::ErrorKind::AddrNotAvailable);
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, PATIENCE) {
            Ok(socket) => {
                socket.set_write_timeout(Some(PATIENCE))?;
                return Ok(socket);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

#[cfg(test)]
mod tests {
    use std::{io::Read, net::TcpListener};

    use super::*;
    use tyndall::film::Crop;

    /// A packet is its length [bytes, u32], then its kind; 4 creates an image, 6 updates it.
    #[test]
    fn the_viewer_is_told_to_create_the_image_and_then_to_update_it() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let mut tev = Tev::connect(&address, "milk").unwrap();
        let (mut viewer, _) = listener.accept().unwrap();
        let mut film = Film::new(4, 3, Crop { min: (1, 1), max: (3, 2) });
        film.pixels[1].add([0.25; 3]);
        tev.show(&film).unwrap();
        tev.show(&film).unwrap();
        drop(tev);

        let mut bytes = Vec::new();
        viewer.read_to_end(&mut bytes).unwrap();
        let mut kinds = Vec::new();
        while !bytes.is_empty() {
            let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
            kinds.push(bytes[4]);
            bytes.drain(..length);
        }
        assert_eq!(kinds, [4, 6, 6]);
    }

    #[test]
    fn no_viewer_is_an_error_with_its_address() {
        let free = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
        assert!(Tev::connect(&free, "x").unwrap_err().to_string().contains(&free));
    }
}
