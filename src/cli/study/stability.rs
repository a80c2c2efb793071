//! `carom study stability`: the stress suite.

use core::fmt::Write as _;

use carom::study::stability::{Case, Extent, Stability, case, cases};
use clap::Args;
use clap::builder::PossibleValuesParser;

use super::StudyFolder;
use crate::cli::failure::Failure;
use crate::cli::print;

/// What `carom study stability` takes.
#[derive(Args, Debug)]
pub struct StabilityArguments {
    /// Cases [default: all]
    #[arg(value_name = "CASE", hide_possible_values = true,
          value_parser = PossibleValuesParser::new(cases().iter().map(|case| case.name)))]
    cases: Vec<String>,

    /// Runs of about a hundredth of the length
    #[arg(long)]
    quick: bool,

    /// List the cases, and make no study
    #[arg(long)]
    list: bool,

    #[command(flatten)]
    folder: StudyFolder,
}

impl StabilityArguments {
    /// Makes the study, and prints its report.
    pub fn run(self) -> Result<(), Failure> {
        if self.list {
            return print(&list());
        }
        let chosen: Vec<&'static Case> = match self.cases.as_slice() {
            [] => cases().iter().collect(),
            names => names.iter().filter_map(|name| case(name)).collect(),
        };
        let extent = if self.quick { Extent::Quick } else { Extent::Full };
        self.folder.conduct(&Stability::new(chosen, extent))
    }
}

fn list() -> String {
    let width = cases().iter().map(|case| case.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for case in cases() {
        let _ = writeln!(text, "{:width$}  {}", case.name, case.title);
    }
    text
}
