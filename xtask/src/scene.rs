//! Scenes that are run here.

use anyhow::Result;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;

use crate::commands::root;

/// A file of `scenes/` by name.
pub fn read(name: &str) -> Result<SceneFile> {
    Ok(SceneFile::read(&root().join("scenes").join(format!("{name}.toml")))?)
}

/// The scene in its preload.
pub fn start(file: &SceneFile) -> Result<Simulation> {
    let inputs = file.inputs_over(0.0, file.communication_step)?;
    Ok(Simulation::new(&file.scene, &inputs, 0.0)?)
}
