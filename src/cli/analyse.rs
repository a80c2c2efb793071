//! `carom analyse`: what recorded frames amount to.

use std::path::{Path, PathBuf};

use carom::observe::Analysis;
use carom::output::{FrameFormat, FrameReader, WholeFile, write_findings};
use carom::scene::{AnalysisKind, AnalysisSettings};
use carom::study::chart::Look;

use super::analyses::Found;
use super::arguments::AnalyseArguments;
use super::failure::Failure;
use super::output_file::{Destination, OutputError};
use super::{plot, print};

/// The kinds that frames can have.
pub const KINDS: [(&str, AnalysisKind); 6] = [
    ("radial-distribution", AnalysisKind::RadialDistribution),
    ("mean-squared-displacement", AnalysisKind::MeanSquaredDisplacement),
    ("velocity-autocorrelation", AnalysisKind::VelocityAutocorrelation),
    ("speed-distribution", AnalysisKind::SpeedDistribution),
    ("bond-order", AnalysisKind::BondOrder),
    ("structure-factor", AnalysisKind::StructureFactor),
];

/// An analysis under way, and where it is to be written.
struct Analysing {
    kind: AnalysisKind,
    shown: PathBuf,
    target: PathBuf,
    analysis: Analysis,
}

/// Analyses recorded frames.
pub fn analyse(arguments: &AnalyseArguments) -> Result<(), Failure> {
    let path = &arguments.file;
    if matches!(FrameFormat::of(path), None | Some(FrameFormat::ParaView)) {
        let (path, endings) = (path.display(), FrameReader::ENDINGS);
        return Err(Failure::Argument(format!("FILE is {path}; its ending must be {endings}")));
    }
    let mut analysing: Vec<Analysing> = Vec::new();
    let mut left_out = Vec::new();
    let mut passed = 0;
    for (number, frame) in FrameReader::open(path)?.enumerate() {
        let frame = frame?;
        let time = frame.time.or(arguments.every.map(|every| number as f64 * every));
        // Without times the frames are numbered, which is enough for what has none.
        let moment = frame.moment(time.unwrap_or(number as f64));
        if arguments.from.is_some_and(|from| moment.time < from) {
            passed += 1;
            continue;
        }
        if analysing.is_empty() {
            for settings in chosen(arguments) {
                check_time(&settings, time.is_some(), path)?;
                match Analysis::new(&settings, &moment) {
                    Ok(analysis) => analysing.push(begin(arguments, settings.kind, analysis)?),
                    Err(unfit) if arguments.kind.is_empty() && unfit.key == "kind" => {
                        left_out.push(format!("{}: {}", settings.kind.name(), unfit.wanted));
                    }
                    Err(unfit) => {
                        return Err(Failure::Argument(format!("--{unfit}")));
                    }
                }
            }
        }
        for it in &mut analysing {
            it.analysis.look(&moment);
        }
    }
    if analysing.is_empty() {
        let path = path.display();
        return Err(Failure::Argument(match (passed, left_out.first()) {
            (_, Some(reason)) => format!("{path}: none of the analyses can be made ({reason})"),
            (0, None) => format!("{path} has no frames"),
            (passed, None) => format!("--from is behind the last of {passed} frames of {path}"),
        }));
    }
    let mut text = String::new();
    for reason in left_out {
        text += &format!("left out  {reason}\n\n");
    }
    for it in analysing {
        text += &format!("{}\n", finish(it, arguments.plot)?.table());
    }
    print(&text)
}

/// The settings of each kind that is asked for: those of no kind are of all.
fn chosen(arguments: &AnalyseArguments) -> Vec<AnalysisSettings> {
    let kinds = match &arguments.kind[..] {
        [] => KINDS.map(|(_, kind)| kind).to_vec(),
        kinds => kinds.to_vec(),
    };
    let settings = |kind| AnalysisSettings {
        kind,
        bins: arguments.bins,
        range: arguments.range,
        species: (!arguments.species.is_empty()).then(|| arguments.species.clone()),
    };
    kinds.into_iter().map(settings).collect()
}

/// What follows bodies in time needs times.
fn check_time(settings: &AnalysisSettings, is_known: bool, path: &Path) -> Result<(), Failure> {
    let follows = matches!(
        settings.kind,
        AnalysisKind::MeanSquaredDisplacement | AnalysisKind::VelocityAutocorrelation
    );
    if is_known || !follows {
        return Ok(());
    }
    Err(Failure::Argument(format!(
        "{} has no times; give the time from one frame to the next with --every TIME, or another \
         --kind than {}",
        path.display(),
        settings.kind.name()
    )))
}

fn begin(
    arguments: &AnalyseArguments,
    kind: AnalysisKind,
    analysis: Analysis,
) -> Result<Analysing, Failure> {
    let path = &arguments.file;
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
    let folder = arguments.output.as_deref().or(path.parent()).unwrap_or(Path::new(""));
    let shown = folder.join(format!("{stem}-{}.csv", kind.name()));
    let refused = |source| Failure::Open { option: "-o", source };
    let Destination::Regular(target) = Destination::of(&shown).map_err(refused)? else {
        let shown = shown.display();
        return Err(Failure::Argument(format!("{shown} is no file that can be replaced")));
    };
    Ok(Analysing { kind, shown, target, analysis })
}

/// Writes what was found, and draws it if that is asked.
fn finish(it: Analysing, plot: bool) -> Result<Found, Failure> {
    let findings = it.analysis.findings();
    let write = || {
        let file = WholeFile::beside(&it.target)?;
        write_findings(file, &findings)?.finish()
    };
    write().map_err(|source| OutputError::Write { path: it.shown.clone(), source })?;
    if plot {
        plot::draw(&it.shown, &it.shown.with_extension("svg"), &[], &Look::default())?;
    }
    Ok(Found::of(it.kind, &it.shown, findings))
}
