//! Spheres, one at a time or many at once, as a scene describes them.

use core::ops::RangeInclusive;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

/// A figure that all spheres of a group share, or that is spread evenly
/// between two bounds.
///
/// ```
/// use carom::scene::Spread;
///
/// let radius = Spread::from(0.1..=0.2);
/// assert_eq!((radius.least(), radius.greatest()), (0.1, 0.2));
/// assert_eq!(Spread::from(0.5), Spread::Same(0.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// The same for all.
    Same(f64),
    /// Uniform between two bounds.
    Uniform {
        /// The lower bound.
        least: f64,
        /// The upper bound.
        greatest: f64,
    },
}

impl Spread {
    /// The upper bound.
    #[must_use]
    pub fn greatest(&self) -> f64 {
        match *self {
            Self::Same(value) => value,
            Self::Uniform { greatest, .. } => greatest,
        }
    }

    /// The lower bound.
    #[must_use]
    pub fn least(&self) -> f64 {
        match *self {
            Self::Same(value) => value,
            Self::Uniform { least, .. } => least,
        }
    }
}

impl From<f64> for Spread {
    fn from(value: f64) -> Self {
        Self::Same(value)
    }
}

impl From<RangeInclusive<f64>> for Spread {
    fn from(range: RangeInclusive<f64>) -> Self {
        Self::Uniform { least: *range.start(), greatest: *range.end() }
    }
}

/// How many spheres are laid out.
///
/// ```
/// use carom::Spheres;
/// use carom::scene::Arrangement;
/// assert_eq!(Spheres::new(4, Arrangement::Fcc), Spheres::fcc(4));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
pub enum Arrangement {
    /// A face-centred cubic lattice, the densest there is.
    Fcc,
    /// A simple cubic lattice.
    Cubic,
    /// One after another at random where there is room: random sequential
    /// insertion, which gives up near a packing fraction of 0.38.
    Random,
}

/// What a sphere is and how it starts, apart from its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Make {
    pub(super) radius: Option<Spread>,
    pub(super) mass: Option<Spread>,
    pub(super) density: Option<Spread>,
    pub(super) inertia_factor: f64,
    pub(super) velocity: [f64; 3],
    pub(super) spin: [f64; 3],
}

impl Default for Make {
    fn default() -> Self {
        Self {
            radius: None,
            mass: None,
            density: None,
            inertia_factor: 0.4,
            velocity: [0.0; 3],
            spin: [0.0; 3],
        }
    }
}

/// The setters that one sphere and a group of them have in common.
macro_rules! make_setters {
    () => {
        /// Radius, length: a number, or a range to spread evenly over. It has
        /// no default.
        ///
        /// ```
        /// use carom::{Scene, Spheres};
        ///
        /// let grains = Spheres::cubic(8).radius(0.1..=0.2).within([0.0; 3], [2.0; 3]);
        /// let scene = Scene::<f64>::builder().spheres(grains).build()?;
        /// assert!(scene.bodies.radius.greatest() <= 0.2);
        /// # Ok::<(), carom::SceneError>(())
        /// ```
        #[must_use]
        pub fn radius(mut self, radius: impl Into<Spread>) -> Self {
            self.make.radius = Some(radius.into());
            self
        }

        /// Mass: a number, or a range to spread evenly over; 1 by default.
        ///
        /// ```
        /// # use carom::{Scene, Sphere};
        /// let ball = Sphere::new([0.0; 3]).radius(0.5).mass(2.0);
        /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
        /// assert_eq!(scene.bodies.mass.of(0), 2.0);
        /// # Ok::<(), carom::SceneError>(())
        /// ```
        #[must_use]
        pub fn mass(mut self, mass: impl Into<Spread>) -> Self {
            self.make.mass = Some(mass.into());
            self
        }

        /// Mass per volume, instead of the mass.
        ///
        /// ```
        /// # use carom::{Scene, Sphere};
        /// let ball = Sphere::new([0.0; 3]).radius(0.5).density(6.0);
        /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
        /// assert!((scene.bodies.mass.of(0) - std::f64::consts::PI).abs() < 1e-15);
        /// # Ok::<(), carom::SceneError>(())
        /// ```
        #[must_use]
        pub fn density(mut self, density: impl Into<Spread>) -> Self {
            self.make.density = Some(density.into());
            self
        }

        /// `q` in the moment of inertia `I = q m r²`, above 0 and up to 2/3:
        /// 2/5, the default, for a solid sphere, 2/3 for a thin shell. 0, a
        /// point mass, is refused: its spin would have no inertia to a rough
        /// contact, and to smooth ones the factor makes no difference.
        ///
        /// ```
        /// # use carom::{Scene, Sphere};
        /// let ball = Sphere::new([0.0; 3]).radius(0.5).inertia_factor(0.5);
        /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
        /// assert_eq!(scene.bodies.inertia.of(0), 0.125);
        /// # Ok::<(), carom::SceneError>(())
        /// ```
        #[must_use]
        pub fn inertia_factor(mut self, factor: f64) -> Self {
            self.make.inertia_factor = factor;
            self
        }

        /// Velocity of the centre, length per time; added to that of the
        /// temperature.
        ///
        /// ```
        /// # use carom::{Scene, Sphere};
        /// let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
        /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
        /// assert_eq!(scene.bodies.velocity_of(0).x, 1.0);
        /// # Ok::<(), carom::SceneError>(())
        /// ```
        #[must_use]
        pub fn velocity(mut self, velocity: [f64; 3]) -> Self {
            self.make.velocity = velocity;
            self
        }

        /// Angular velocity, rad per time, in the world frame; added to that of
        /// the temperature.
        ///
        /// ```
        /// # use carom::{Scene, Sphere};
        /// let ball = Sphere::new([0.0; 3]).radius(0.5).spin([0.0, 0.0, 3.0]);
        /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
        /// assert_eq!(scene.bodies.spin_of(0).z, 3.0);
        /// # Ok::<(), carom::SceneError>(())
        /// ```
        #[must_use]
        pub fn spin(mut self, spin: [f64; 3]) -> Self {
            self.make.spin = spin;
            self
        }
    };
}

pub(super) use make_setters;

/// One sphere of a scene.
///
/// ```
/// use carom::scene::Sphere;
/// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).mass(2.0).spin([0.0, 3.0, 0.0]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    pub(super) position: [f64; 3],
    pub(super) make: Make,
}

impl Sphere {
    /// A sphere at rest with its centre at `position`. Its radius has to be
    /// set.
    ///
    /// ```
    /// use carom::{Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
    /// assert_eq!(scene.bodies.position_of(0).z, 1.0);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn new(position: [f64; 3]) -> Self {
        Self { position, make: Make::default() }
    }

    make_setters!();
}

/// Many spheres of a scene.
///
/// They fill the box given by [`within`](Spheres::within), or else the periodic
/// box, or else the interior of the container. Spheres of different sizes are
/// numbered from the largest down.
///
/// ```
/// use carom::scene::Spheres;
/// let gas = Spheres::random(1_000).radius(0.1).temperature(1.0).seed(7);
/// let grains = Spheres::cubic(64).radius(0.1..=0.5).density(2500.0).within([0.0; 3], [8.0; 3]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Spheres {
    pub(super) count: u64,
    pub(super) arrangement: Arrangement,
    pub(super) bounds: Option<[[f64; 3]; 2]>,
    pub(super) number_density: Option<f64>,
    pub(super) temperature: f64,
    pub(super) spin_temperature: f64,
    pub(super) seed: Option<u64>,
    pub(super) make: Make,
}

impl Spheres {
    /// `count` spheres in an arrangement. Their radius has to be set.
    ///
    /// ```
    /// # use carom::{Scene, Spheres};
    /// use carom::scene::Arrangement;
    ///
    /// let gas = Spheres::new(27, Arrangement::Cubic).radius(0.1).within([0.0; 3], [3.0; 3]);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// assert_eq!(scene.bodies.len(), 27);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn new(count: u64, arrangement: Arrangement) -> Self {
        Self {
            count,
            arrangement,
            bounds: None,
            number_density: None,
            temperature: 0.0,
            spin_temperature: 0.0,
            seed: None,
            make: Make::default(),
        }
    }

    /// `count` spheres at random places that do not overlap.
    ///
    /// ```
    /// # use carom::{Scene, Spheres};
    /// let gas = Spheres::random(10).radius(0.1).within([0.0; 3], [2.0; 3]);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// assert_eq!(scene.bodies.len(), 10);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn random(count: u64) -> Self {
        Self::new(count, Arrangement::Random)
    }

    /// `count` spheres on a face-centred cubic lattice.
    ///
    /// ```
    /// # use carom::{Scene, Spheres};
    /// let gas = Spheres::fcc(4).radius(0.1).within([0.0; 3], [1.0; 3]);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// assert_eq!(scene.bodies.len(), 4);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn fcc(count: u64) -> Self {
        Self::new(count, Arrangement::Fcc)
    }

    /// `count` spheres on a simple cubic lattice.
    ///
    /// ```
    /// # use carom::{Scene, Spheres};
    /// let gas = Spheres::cubic(8).radius(0.5).within([0.0; 3], [2.0; 3]);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// // Two in each direction fill the box.
    /// assert_eq!(scene.bodies.len(), 8);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn cubic(count: u64) -> Self {
        Self::new(count, Arrangement::Cubic)
    }

    /// The box to fill, surfaces included, length.
    ///
    /// ```
    /// # use carom::{Scene, Spheres};
    /// let gas = Spheres::random(10).radius(0.1).within([4.0; 3], [6.0; 3]);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// assert!(scene.bodies.position[0].iter().all(|x| (4.1..=5.9).contains(x)));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn within(mut self, lower: [f64; 3], upper: [f64; 3]) -> Self {
        self.bounds = Some([lower, upper]);
        self
    }

    /// Spheres per volume; it sizes a
    /// [periodic cube](super::SceneBuilder::periodic_cube).
    ///
    /// ```
    /// use carom::{Scene, Spheres};
    ///
    /// let fluid = Spheres::fcc(32).radius(0.5).number_density(0.5);
    /// let scene = Scene::<f64>::builder().periodic_cube().spheres(fluid).build()?;
    /// assert!(scene.periodic.is_some_and(|cube| (cube.sides().x - 4.0).abs() < 1e-12));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn number_density(mut self, density: f64) -> Self {
        self.number_density = Some(density);
        self
    }

    /// `kT`, energy: each component of the velocities is normal with variance
    /// `kT/m`, and then the group's total momentum is removed.
    ///
    /// ```
    /// use carom::{Momentum, Scene, Spheres, Temperature};
    ///
    /// let gas = Spheres::cubic(1000).radius(0.1).within([0.0; 3], [9.0; 3]).temperature(2.0);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// let found = Temperature::of(&scene.bodies).ok_or("fewer than two")?;
    /// assert!((found.translational - 2.0).abs() < 0.2);
    /// assert!(Momentum::of(&scene.bodies).0.length() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn temperature(mut self, temperature: f64) -> Self {
        self.temperature = temperature;
        self
    }

    /// `kT` of rotation, energy: each component of the angular velocities is
    /// normal with variance `kT/I`.
    ///
    /// ```
    /// use carom::{Scene, Spheres, Temperature};
    ///
    /// let gas = Spheres::cubic(1000).radius(0.1).within([0.0; 3], [9.0; 3]).spin_temperature(2.0);
    /// let scene = Scene::<f64>::builder().spheres(gas).build()?;
    /// let found = Temperature::of(&scene.bodies).ok_or("fewer than two")?;
    /// assert!((found.rotational - 2.0).abs() < 0.2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn spin_temperature(mut self, temperature: f64) -> Self {
        self.spin_temperature = temperature;
        self
    }

    /// The seed of this group's random numbers, instead of the scene's.
    ///
    /// ```
    /// use carom::{Scene, Spheres};
    ///
    /// // Two groups, each with numbers of its own.
    /// let gas = |x, seed| Spheres::random(10).radius(0.1).within([x; 3], [x + 2.0; 3]).seed(seed);
    /// let scene = Scene::<f64>::builder().spheres(gas(0.0, 1)).spheres(gas(2.0, 2)).build()?;
    /// assert_eq!(scene.bodies.len(), 20);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = Some(seed);
        self
    }

    make_setters!();
}
