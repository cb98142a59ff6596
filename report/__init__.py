"""The report and pages of docs/ that are computed: run by `cargo xtask report`, `effects`, `accuracy` and others."""
