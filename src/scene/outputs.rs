//! Outputs: what a scene file asks of a run besides the scene: what it writes on its way,
//! and from when on it is measured.

use super::error::{Problem, SceneError};
use super::file::SceneFile;
use super::raw::{Number, RawAnalyse, RawSeries, RawSnapshot, RawWritten, Whole, number};
use super::settings::{AnalysisKind, AnalysisSettings, Written};
use super::spheres::Spread;
use crate::numbers::array::Each;

/// An entry of `[[analyse]]`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AskedAnalysis {
    /// What is analysed.
    pub settings: AnalysisSettings,
    /// Where it is written, and how often the bodies are looked at.
    pub written: Written,
}

impl SceneFile {
    /// `[record]`: the frames that a run writes.
    ///
    /// # Errors
    /// If `every` is no length of time.
    pub fn record(&self) -> Result<Written, SceneError> {
        let RawWritten { file, every } = &self.raw.record;
        self.written("record", file.as_deref(), *every)
    }

    /// The tables of the file that ask a run for files, as they are written there.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let file = SceneFile::parse("gas", "[record]\nfile = \"gas.npz\"\nevery = 0.1\n")?;
    /// assert_eq!(file.asked_outputs(), ["[record]"]);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn asked_outputs(&self) -> Vec<&'static str> {
        let asked = [
            ("[record]", self.raw.record.file.is_some()),
            ("[series]", self.raw.series.file.is_some()),
            ("[snapshot]", self.raw.snapshot.file.is_some()),
            ("[[analyse]]", !self.raw.analyse.is_empty()),
        ];
        asked.into_iter().filter(|(_, is_asked)| *is_asked).map(|(table, _)| table).collect()
    }

    /// A path in the folder of the scene file.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let file = SceneFile::parse("gas", "")?;
    /// assert_eq!(file.in_folder("gas.csv"), std::path::Path::new("gas.csv"));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn in_folder(&self, name: &str) -> std::path::PathBuf {
        self.folder.join(name)
    }

    /// `[series]`: the time series that a run writes.
    ///
    /// # Errors
    /// If `every` is no length of time.
    pub fn series(&self) -> Result<Written, SceneError> {
        let RawSeries { file, every, .. } = &self.raw.series;
        self.written("series", file.as_deref(), *every)
    }

    /// `columns` of `[series]`: the names of what is in it.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let file = SceneFile::parse("gas", "[series]\ncolumns = [\"time\", \"energy\"]\n")?;
    /// assert_eq!(file.series_columns().map(<[_]>::len), Some(2));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn series_columns(&self) -> Option<&[String]> {
        self.raw.series.columns.as_deref()
    }

    /// `[snapshot]`: where and how often a run is kept.
    ///
    /// # Errors
    /// If `every` is no length of time.
    pub fn snapshot(&self) -> Result<Written, SceneError> {
        let RawSnapshot { file, every, .. } = &self.raw.snapshot;
        self.written("snapshot", file.as_deref(), *every)
    }

    /// `wall` of `[snapshot]`: minutes of a clock from one to the next.
    ///
    /// # Errors
    /// If it is no length of time.
    pub fn snapshot_wall(&self) -> Result<Option<f64>, SceneError> {
        self.length_of_time("snapshot.wall", self.raw.snapshot.wall)
    }

    /// The error of a value that means nothing to what reads it after the scene.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let file = SceneFile::parse("ball.toml", "[record]\nfile = \"ball.vtk\"\n")?;
    /// let error = file.mistake("record.file", "\"ball.vtk\"", "it must end in .dump");
    /// assert_eq!(
    ///     error.to_string(),
    ///     "ball.toml:2: record.file is \"ball.vtk\"; it must end in .dump"
    /// );
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn mistake(&self, key: &str, found: &str, wanted: &str) -> SceneError {
        let problem = Problem::Value { found: found.to_owned(), wanted: wanted.to_owned() };
        self.origin().error(key, problem)
    }

    /// `[[analyse]]`: what is analysed on the way of a run.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let text = "[[analyse]]\nkind = \"structure-factor\"\nrange = 20\nevery = 0.5\n";
    /// let analyses = SceneFile::parse("gas", text)?.analyses()?;
    /// assert_eq!(analyses[0].settings.range, Some([None, Some(20.0)]));
    /// assert_eq!(analyses[0].written.every, Some(0.5));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// If one has no `kind`, or its `every` is no length of time.
    pub fn analyses(&self) -> Result<Vec<AskedAnalysis>, SceneError> {
        let read = |(index, raw): (usize, &RawAnalyse)| {
            let entry = format!("analyse[{index}]");
            let kinds = || AnalysisKind::ALL.each(|kind| format!("\"{}\"", kind.name())).join(", ");
            let kind = raw.kind.ok_or_else(|| {
                let wanted = format!("it must be one of {}", kinds());
                self.origin().error(format!("{entry}.kind"), Problem::missing(&wanted))
            })?;
            let range = raw.range.map(|range| match range {
                Spread::Same(to) => [None, Some(to)],
                Spread::Uniform { least, greatest } => [Some(least), Some(greatest)],
            });
            let whole = |whole: &Whole| whole.0;
            let settings = AnalysisSettings {
                kind,
                bins: raw.bins.as_ref().map(whole),
                range,
                species: raw.species.as_ref().map(|species| species.iter().map(whole).collect()),
            };
            let written = self.written(&entry, raw.file.as_deref(), raw.every)?;
            Ok(AskedAnalysis { settings, written })
        };
        self.raw.analyse.iter().enumerate().map(read).collect()
    }

    fn written(
        &self,
        table: &str,
        file: Option<&str>,
        every: Option<Number>,
    ) -> Result<Written, SceneError> {
        let every = self.length_of_time(&format!("{table}.every"), every)?;
        Ok(Written { file: file.map(|file| self.folder.join(file)), every })
    }

    /// The value of a key, if it is one that time can pass in.
    fn length_of_time(&self, key: &str, time: Option<Number>) -> Result<Option<f64>, SceneError> {
        let time = number(time);
        if let Some(time) = time.filter(|time| !(time.is_finite() && *time > 0.0)) {
            let wanted = "a time must be finite and greater than 0";
            return Err(self.mistake(key, &format!("{time:?}"), wanted));
        }
        Ok(time)
    }

    /// `equilibrate`: how much of a run passes before anything is measured, time; 0 by
    /// default.
    ///
    /// ```
    /// use carom::SceneFile;
    /// assert_eq!(SceneFile::parse("gas", "equilibrate = 2")?.equilibration(10.0)?, 2.0);
    /// assert!(SceneFile::parse("gas", "equilibrate = 2")?.equilibration(1.0).is_err());
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// If it is negative, or leaves nothing of a run of this duration.
    pub fn equilibration(&self, duration: f64) -> Result<f64, SceneError> {
        let Some(time) = number(self.raw.equilibrate) else { return Ok(0.0) };
        if (0.0..duration).contains(&time) {
            return Ok(time);
        }
        let wanted = format!(
            "it is a part of the duration, from 0 to below {duration:?}, before anything is measured"
        );
        Err(self.mistake("equilibrate", &format!("{time:?}"), &wanted))
    }
}
