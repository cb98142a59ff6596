//! Nothing: cargo then builds what stands under `[build-dependencies]`.

fn main() {}
