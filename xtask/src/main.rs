//! Repository chores.
mod bench_rays;
mod embree;
fn main() -> anyhow::Result<()> {
    bench_rays::run()
}
