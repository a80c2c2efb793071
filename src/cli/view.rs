//! `carom view`: motion as one page for a browser, with all that it needs in it.

mod film;
mod page;

use std::path::PathBuf;

use carom::output::write_whole;

use super::arguments::ViewArguments;
use super::failure::Failure;
use super::output_file::{Destination, OutputError};
use super::shown::{Looks, Moment, Scenery, Subject, frames, run_scene};
use super::{print, standard_output};
use film::{Film, TooLarge};

/// Frames of a scene, beside its start.
const USUAL: u64 = 300;

/// Makes the page of a scene or of frames.
pub fn view(arguments: &ViewArguments) -> Result<(), Failure> {
    let subject = Subject::of(&arguments.scene)?;
    let output = match &arguments.output {
        Some(output) => output.clone(),
        None => PathBuf::from(subject.name() + ".html"),
    };
    let shown = output.display();
    if output.extension().is_none_or(|ending| ending != "html") {
        return Err(Failure::Argument(format!("-o is {shown}; its ending must be .html")));
    }
    let target = Destination::replaceable("-o", &output)?;
    standard_output()?;
    let most = arguments.limit * 1_000_000;
    let mut film = Film::new(most);
    let scenery = filmed(&subject, arguments, &mut film)?;
    let too_large = |TooLarge { bytes }| {
        Failure::Argument(format!(
            "one moment of {} takes {} MB in a page, and --limit is {}; give a greater one, or draw \
             it by `carom picture`",
            subject.name(),
            bytes.div_ceil(1_000_000),
            arguments.limit
        ))
    };
    let film = film.finished().map_err(too_large)?;
    let page = page::page(&scenery, &film);
    let written = write_whole(&target, page.as_bytes());
    written.map_err(|source| OutputError::Write { path: output.clone(), source })?;
    print(&format!("{shown}: {}, {:.1} MB\n", film.described(), page.len() as f64 / 1e6))
}

/// What does not move; all that does goes into the film.
fn filmed(
    subject: &Subject,
    arguments: &ViewArguments,
    film: &mut Film,
) -> Result<Scenery, Failure> {
    match subject {
        Subject::Scene(file) => {
            let duration = file.run_duration()?;
            film.comes_and_goes(file.has_flow());
            let looks = Looks::Frames(arguments.frames.unwrap_or(USUAL), duration);
            let execution = arguments.scene.execution();
            run_scene(file, execution, looks, &mut |scenery, moment| film.add(scenery, moment))
        }
        Subject::Frames(path) => {
            if arguments.scene.duration.is_some() {
                let path = path.display();
                return Err(Failure::Argument(format!(
                    "--duration is for a scene, and {path} is as long as it is"
                )));
            }
            film.keep_at_most(arguments.frames);
            let scenery = frames(path, &mut |scenery: &Scenery, moment: Moment| {
                film.add(scenery, moment);
                true
            })?;
            scenery.ok_or_else(|| {
                Failure::Argument(format!("{} has no frame, which could be shown", path.display()))
            })
        }
        Subject::State(path) => Err(Failure::Argument(format!(
            "{} is a state at one time; `carom picture` draws it",
            path.display()
        ))),
    }
}
