//! Skin: how far apart two bodies may be to be remembered as candidates.
//!
//! With a wide skin the search is done seldom and many pairs are tested in each
//! step; with a narrow one it is the other way round. The choice changes no
//! result, only the time.

/// What a search and a test cost, in nanoseconds on the machines measured; only
/// their proportions matter. Three times as much for a search among many fixed parts
/// gained nothing there.
const SEARCH: f64 = 30.0;
const SEARCH_PER_NEIGHBOUR: f64 = 5.0;
const TEST_PER_NEIGHBOUR: f64 = 1.5;

/// How many pairs each body is in, each counted once, whose gaps are below the
/// skin, in diameters, at a density in bodies a diameter cubed.
pub(super) fn neighbours(density: f64, skin: f64) -> f64 {
    density * (2.0 / 3.0 * core::f64::consts::PI * (1.0 + skin).powi(3))
}

/// The skin, in diameters, of the least cost a step.
///
/// `travel` is how far a body moves towards another in a step at most, in
/// diameters; `density` the number of bodies a diameter cubed.
pub(super) fn best_skin(travel: f64, density: f64) -> f64 {
    let cost = |skin: f64| {
        let neighbours = neighbours(density, skin);
        let steps = (skin / (2.0 * travel)).floor().max(1.0);
        (SEARCH + SEARCH_PER_NEIGHBOUR * neighbours) / steps + TEST_PER_NEIGHBOUR * neighbours
    };
    let mut best = (0.05, cost(0.05));
    let mut skin = 0.05;
    while skin < 20.0 {
        skin *= 1.1;
        let candidate = (skin, cost(skin));
        if candidate.1 < best.1 {
            best = candidate;
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::best_skin;

    #[test]
    fn dilute_and_fast_systems_look_further() {
        assert!(best_skin(0.01, 0.2) > best_skin(0.01, 0.9));
        assert!(best_skin(0.05, 0.5) > best_skin(0.001, 0.5));
    }

    #[test]
    fn extremes_have_a_skin_too() {
        assert!(best_skin(0.0, 0.0) >= 0.05);
        assert!(best_skin(f64::INFINITY, 0.5) < 0.1);
    }
}
