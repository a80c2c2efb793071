//! Edit: bodies with others beside them, or without some of them.

use super::{Bodies, Columns3, PerBody};
use crate::column::Column;
use crate::mat3::Mat3;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

impl<T: Real> Bodies<T> {
    /// One of them with another position, velocity and angular velocity, not turned.
    pub(crate) fn one_moving(&self, index: usize, motion: [Vec3<T>; 3]) -> Self {
        let columns = |vector: Vec3<T>| vector.to_array().each(|c| column([c].into_iter()));
        let [position, velocity, spin] = motion.each(columns);
        let [radius, mass, inertia] = [&self.radius, &self.mass, &self.inertia]
            .each(|figure| PerBody::Same(figure.of(index)));
        let (origin, orientation) = (self.origin, None);
        Self { origin, position, velocity, spin, orientation, radius, mass, inertia }
    }

    /// Puts others behind these.
    pub(crate) fn extend(&mut self, others: &Self) {
        let [own, more] = [self.len(), others.len()];
        if self.orientation.is_some() || others.orientation.is_some() {
            let of = |index: usize| match index.checked_sub(own) {
                None => self.orientation_of(index),
                Some(index) => others.orientation_of(index),
            };
            self.orientation = Some(rows((0..own + more).map(of)));
        }
        for (columns, others) in [
            (&mut self.position, &others.position),
            (&mut self.velocity, &others.velocity),
            (&mut self.spin, &others.spin),
        ] {
            columns.iter_mut().zip(others).for_each(|(column, others)| column.extend(others));
        }
        for (figure, others) in [
            (&mut self.radius, &others.radius),
            (&mut self.mass, &others.mass),
            (&mut self.inertia, &others.inertia),
        ] {
            match (&mut *figure, others) {
                (PerBody::Same(one), PerBody::Same(other)) if one == other => {}
                (figure, others) => {
                    let of = |index: usize| match index.checked_sub(own) {
                        None => figure.of(index),
                        Some(index) => others.of(index),
                    };
                    *figure = PerBody::from_values((0..own + more).map(of), T::ONE);
                }
            }
        }
    }

    /// Those of these indices, in this order.
    ///
    /// ```
    /// use carom::Bodies;
    ///
    /// let row = [[0.0; 3], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]];
    /// let bodies = Bodies::from_positions(&row).radius(0.5).build()?;
    /// assert_eq!(bodies.only(&[2, 0]).position[0][..2], [4.0, 0.0]);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    ///
    /// # Panics
    /// If there is no body of an index, as [`position_of`](Bodies::position_of) does.
    #[must_use]
    pub fn only(&self, kept: &[usize]) -> Self {
        let columns = |columns: &Columns3<T>| {
            let only = |one: &Column<T>| {
                Column::from_values(kept.iter().map(|&index| one[index]), T::ZERO)
            };
            columns.refs().each(only)
        };
        let figure = |figure: &PerBody<T>| match figure {
            PerBody::Same(value) if !kept.is_empty() => PerBody::Same(*value),
            _ => PerBody::from_values(kept.iter().map(|&index| figure.of(index)), T::ONE),
        };
        let is_turned = self.orientation.is_some();
        Self {
            origin: self.origin,
            position: columns(&self.position),
            velocity: columns(&self.velocity),
            spin: columns(&self.spin),
            orientation: is_turned
                .then(|| rows(kept.iter().map(|&index| self.orientation_of(index)))),
            radius: figure(&self.radius),
            mass: figure(&self.mass),
            inertia: figure(&self.inertia),
        }
    }
}

fn column<T: Real>(values: impl Iterator<Item = T>) -> Column<T> {
    let values: Vec<T> = values.collect();
    Column::from_values(values.into_iter(), T::ZERO)
}

/// The elements of orientations, row by row.
fn rows<T: Real>(orientations: impl Iterator<Item = Mat3<T>>) -> Box<[Column<T>; 9]> {
    let rows: Vec<[T; 9]> = orientations.map(Mat3::rows).collect();
    Box::new(array::from_fn(|element| column(rows.iter().map(|row| row[element]))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_beside_and_taken_away_is_as_before() {
        let turned = [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let one = Bodies::from_positions(&[[1.0_f64, 2.0, 3.0]]).radius(0.5);
        let one = one.orientations(&[turned]).build().unwrap();
        let two = Bodies::from_positions(&[[4.0; 3], [5.0; 3]]).radii(&[0.5, 0.25]);
        let two = two.spins(&[[1.0; 3], [2.0; 3]]).build().unwrap();
        let mut three = two.clone();
        three.extend(&one);
        assert_eq!((three.len(), three.radius.of(1), three.radius.of(2)), (3, 0.25, 0.5));
        assert_eq!(three.orientation_of(2).rows(), turned);
        assert_eq!(three.orientation_of(0), Mat3::IDENTITY);
        assert_eq!(three.only(&[2]), one);
        let back = three.only(&[0, 1]);
        assert_eq!(
            (&back.spin, &back.radius, &back.inertia),
            (&two.spin, &two.radius, &two.inertia)
        );
        assert_eq!(three.only(&[]).len(), 0);
    }
}
