//! Skeleton: what all studies have in common, from their points to their files.

use core::fmt::Display;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::chart::Picture;
use super::others::Others;
use super::{Folder, Journal, Order, Point, StudyError, Subject, Watch};

/// A study: the points that it is made of, and what follows from their outcomes.
///
/// ```
/// use core::fmt;
/// use carom::study::{Journal, Order, Point, Report, Study, StudyError, Watch};
///
/// /// What squares are.
/// struct Squares(u64);
///
/// #[derive(serde::Serialize)]
/// struct Found(Vec<u64>);
///
/// impl Study for Squares {
///     const NAME: &'static str = "squares";
///     const ORDER: Order = Order::AtOnce;
///     type Outcome = u64;
///     type Report = Found;
///
///     fn settings(&self) -> impl serde::Serialize {}
///
///     fn points(&self, _: &Journal, _: &dyn Watch) -> Result<Vec<Point<'_, u64>>, StudyError> {
///         Ok((0..self.0).map(|n| Point::new(n.to_string(), 1e-9, move || Ok(n * n))).collect())
///     }
///
///     fn report(&self, squares: Vec<u64>, _: Option<f64>) -> Result<Found, StudyError> {
///         Ok(Found(squares))
///     }
/// }
///
/// impl fmt::Display for Found {
///     fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
///         writeln!(f, "{:?}", self.0)
///     }
/// }
///
/// impl Report for Found {
///     const NAME: &'static str = "squares";
///     type Row<'a> = (u64,);
///
///     fn rows(&self) -> Vec<(u64,)> {
///         self.0.iter().map(|&square| (square,)).collect()
///     }
/// }
///
/// let report = Squares(4).measure(&Journal::unwritten(), &())?;
/// assert_eq!(report.to_string(), "[0, 1, 4, 9]\n");
/// # Ok::<(), StudyError>(())
/// ```
pub trait Study {
    /// What the command line calls it.
    const NAME: &'static str;
    /// One after another, where points measure time.
    const ORDER: Order;
    /// What a point gives.
    type Outcome: Serialize + DeserializeOwned + Send;
    /// What follows from all of them.
    type Report: Report;

    /// The scene that it is of, if it is of one.
    fn subject(&self) -> Option<Subject> {
        None
    }

    /// All else that the outcomes depend on.
    fn settings(&self) -> impl Serialize;

    /// Its points, those that the journal has among them.
    ///
    /// # Errors
    /// If what they need cannot be made.
    fn points(
        &self,
        journal: &Journal,
        watch: &dyn Watch,
    ) -> Result<Vec<Point<'_, Self::Outcome>>, StudyError>;

    /// What follows from the outcomes of all points, in their order. `others` is the number
    /// of processors that other programs kept busy meanwhile, on the average; `None` where
    /// nothing was measured now, or the system does not say.
    ///
    /// # Errors
    /// If the outcomes are not those of its points.
    fn report(
        &self,
        outcomes: Vec<Self::Outcome>,
        others: Option<f64>,
    ) -> Result<Self::Report, StudyError>;

    /// The folder that its results go to, if no other is named.
    fn folder(&self) -> String {
        let scene = self.subject().map_or_else(String::new, |subject| format!("-{}", subject.name));
        format!("study-{}{scene}", Self::NAME)
    }

    /// The outcomes so far, in a folder.
    ///
    /// # Errors
    /// As [`Journal::open`].
    fn journal(&self, folder: &Folder) -> Result<Journal, StudyError> {
        folder.journal(&(Self::NAME, self.subject(), self.settings()))
    }

    /// Makes the study, or what the journal lacks of it.
    ///
    /// # Errors
    /// The first one that a point has, or if the journal cannot be written.
    fn measure(&self, journal: &Journal, watch: &dyn Watch) -> Result<Self::Report, StudyError> {
        let points = self.points(journal, watch)?;
        let is_ahead = points.iter().any(|point| !journal.has(&point.key));
        let others = Others::watch();
        let outcomes = Point::all(&points, journal, Self::ORDER, watch)?;
        let others = others.processors().filter(|_| is_ahead);
        self.report(outcomes, others)
    }
}

/// What a study found: its `Display` is for people, its files are for programs.
pub trait Report: Display + Serialize {
    /// What its tables are called.
    const NAME: &'static str;
    /// A row of the table of comma-separated values; its fields are the columns.
    type Row<'a>: Serialize
    where
        Self: 'a;

    /// The scene that it is of, if it is of one.
    fn subject(&self) -> Option<&Subject> {
        None
    }

    /// The table of comma-separated values.
    fn rows(&self) -> Vec<Self::Row<'_>>;

    /// The pictures, with their names.
    fn pictures(&self) -> Vec<(&'static str, Picture)> {
        Vec::new()
    }

    /// Whether what must never happen has not.
    ///
    /// # Errors
    /// If it has.
    fn verdict(&self) -> Result<(), StudyError> {
        Ok(())
    }

    /// Writes all of it into a folder: `report.txt`, the scene as `scene.toml`, `NAME.csv`,
    /// `NAME.json` and the pictures.
    ///
    /// # Errors
    /// If a file cannot be written.
    fn write(&self, folder: &Folder) -> Result<(), StudyError>
    where
        Self: Sized,
    {
        folder.write("report.txt", self.to_string().as_bytes())?;
        if let Some(subject) = self.subject() {
            folder.write("scene.toml", subject.text.as_bytes())?;
        }
        folder.write_csv(&format!("{}.csv", Self::NAME), &self.rows())?;
        folder.write_json(&format!("{}.json", Self::NAME), self)?;
        self.pictures().iter().try_for_each(|(name, picture)| picture.write(folder, name))
    }
}
