//! `carom explain`: the plan of a scene, and what its meshes are like.

use carom::DoubleDouble;
use carom::engine::{Compiled, World};
use carom::scene::{Precision, SceneFile};
use carom::surroundings::{MeshReport, Shape};

use super::arguments::SceneArguments;
use super::failure::Failure;
use super::print;
use super::scene_argument::scene_file;

/// Prints what the engine does for a scene.
pub fn explain(arguments: &SceneArguments) -> Result<(), Failure> {
    let file = scene_file(arguments)?;
    let plan = match file.precision {
        Precision::F32 => plan::<f32>(&file, arguments)?,
        Precision::DoubleDouble => plan::<DoubleDouble>(&file, arguments)?,
        _ => plan::<f64>(&file, arguments)?,
    };
    print(&plan)
}

fn plan<T: Compiled>(file: &SceneFile, arguments: &SceneArguments) -> Result<String, Failure> {
    let scene = file.build::<T>()?;
    let meshes = scene.surroundings.iter().map(Shape::mesh).enumerate();
    let meshes = meshes.filter_map(|(part, mesh)| Some(rows(part, &mesh?.report())));
    let meshes: String = meshes.collect();
    let world = World::<T>::new(scene, arguments.execution())?;
    let plan = world.plan().to_string();
    Ok(format!("{}\n\n{}\n{meshes}", file.name, plan.trim_end()))
}

/// What a mesh is like, in rows as those of the plan.
fn rows(part: usize, report: &MeshReport) -> String {
    let counted = |count: usize, one: &str, more: &str| {
        format!("{count} {}", if count == 1 { one } else { more })
    };
    let edges = |count: usize, kind: &str| {
        counted(count, &format!("{kind} edge"), &format!("{kind} edges"))
    };
    let [lower, upper] = report.bounds;
    let closed = match (report.is_closed(), report.flipped_edges) {
        (true, 0) => format!("closed, volume {:?}", report.volume),
        (true, _) => "closed".to_owned(),
        _ => "open".to_owned(),
    };
    let parts = [
        (
            format!("surroundings[{part}]"),
            format!(
                "{} between {}, {} after seams, {}",
                counted(report.triangles, "triangle", "triangles"),
                counted(report.vertices, "vertex", "vertices"),
                counted(report.faces, "face", "faces"),
                counted(report.components, "component", "components"),
            ),
        ),
        (String::new(), format!("bounds {lower:?} to {upper:?}")),
        (
            String::new(),
            format!(
                "{closed}: {}, {}, {}, {}",
                edges(report.open_edges, "open"),
                edges(report.non_manifold_edges, "non-manifold"),
                edges(report.flipped_edges, "flipped"),
                counted(report.degenerate, "degenerate triangle", "degenerate triangles"),
            ),
        ),
    ];
    parts.into_iter().map(|(what, how)| format!("{what:<22}{how}\n")).collect()
}
