//! Compiled: the precisions that scenes are built in.

use super::check_bodies::Placed;
use super::checked::Scene;
use super::description::Description;
use super::error::SceneError;
#[cfg(feature = "files")]
use super::file::SceneFile;
#[cfg(feature = "study")]
use crate::real::DoubleDouble;
use crate::real::Real;

/// A precision that this crate builds scenes in.
///
/// The checks and the placement are compiled here once, so that a crate that builds
/// scenes does not compile them again.
///
/// ```
/// use carom::scene::Buildable;
/// use carom::{Scene, Sphere};
///
/// fn bodies<T: Buildable>() -> Result<usize, carom::SceneError> {
///     let scene = Scene::<T>::builder().sphere(Sphere::new([0.0; 3]).radius(0.5)).build()?;
///     Ok(scene.bodies.len())
/// }
/// assert_eq!(bodies::<f32>()?, bodies::<f64>()?);
/// # Ok::<(), carom::SceneError>(())
/// ```
pub trait Buildable: Real + sealed::Scenes {}

pub(super) mod sealed {
    #[cfg(feature = "files")]
    use super::SceneFile;
    use super::{Description, Placed, Real, Scene, SceneError};

    /// What makes the scenes of a precision; not generic, so that it is compiled in this
    /// crate.
    pub trait Scenes: Real {
        /// Checks a description, places the spheres, and checks what they make together;
        /// of ready bodies only what was `placed`, if that is given.
        fn checked(
            asked: Description<Self>,
            placed: Option<Placed<'_>>,
        ) -> Result<Scene<Self>, SceneError>;

        #[cfg(feature = "files")]
        fn of_file(file: &SceneFile) -> Result<Scene<Self>, SceneError>;
    }
}

macro_rules! compile {
    ($($real:ty),*) => {$(
        impl Buildable for $real {}

        impl sealed::Scenes for $real {
            fn checked(
                asked: Description<Self>,
                placed: Option<Placed<'_>>,
            ) -> Result<Scene<Self>, SceneError> {
                Scene::checked(asked, placed)
            }

            #[cfg(feature = "files")]
            fn of_file(file: &SceneFile) -> Result<Scene<Self>, SceneError> {
                Scene::checked(file.description()?, None)
            }
        }
    )*};
}

compile!(f32, f64);
#[cfg(feature = "study")]
compile!(DoubleDouble);
