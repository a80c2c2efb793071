//! `carom explain`: the plan of a scene.

use carom::engine::{Compiled, World};
use carom::scene::{Precision, SceneFile};

use super::arguments::SceneArguments;
use super::failure::Failure;
use super::print;
use super::scene_argument::scene_file;

/// Prints what the engine does for a scene.
pub fn explain(arguments: &SceneArguments) -> Result<(), Failure> {
    let file = scene_file(arguments)?;
    let plan = match file.precision {
        Precision::F32 => plan::<f32>(&file, arguments)?,
        _ => plan::<f64>(&file, arguments)?,
    };
    print(&plan)
}

fn plan<T: Compiled>(file: &SceneFile, arguments: &SceneArguments) -> Result<String, Failure> {
    let world = World::<T>::new(file.build()?, arguments.execution())?;
    let plan = world.plan().to_string();
    Ok(format!("{}\n\n{}\n", file.name, plan.trim_end()))
}
