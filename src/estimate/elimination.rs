//! In which order unknowns are eliminated: those of a maneuver of its own meet no other maneuver's, so that with these
//! first, maneuver by maneuver, and what is shared last, nothing fills in (George and Liu 1981, ch. 4).

use nalgebra::DMatrix;

/// The places of a symmetric matrix, sets that do not meet one another first, then those that meet more than half of all.
/// Where all do, the order is as it was.
pub(super) fn order(matrix: &DMatrix<f64>) -> Order {
    let n = matrix.nrows();
    let meets = |place: usize| {
        let column = matrix.column(place);
        (0..n).filter(move |&other| column[other] != 0.0)
    };
    let is_shared: Vec<bool> = (0..n).map(|place| 2 * meets(place).count() > n).collect();
    let mut is_taken = is_shared.clone();
    let mut places = Vec::with_capacity(n);
    for first in 0..n {
        if is_taken[first] {
            continue;
        }
        is_taken[first] = true;
        let mut next = places.len();
        places.push(first);
        while let Some(&place) = places.get(next) {
            next += 1;
            for other in meets(place) {
                if !is_taken[other] {
                    is_taken[other] = true;
                    places.push(other);
                }
            }
        }
    }
    let own = places.len();
    places.extend((0..n).filter(|&place| is_shared[place]));
    Order { places, own }
}

pub(super) struct Order {
    pub places: Vec<usize>,
    /// How many come before those that are shared.
    pub own: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two shared places and three sets of two, of which one place is alone.
    #[test]
    fn sets_come_one_after_the_other_and_what_they_share_last() {
        let shared = [0, 4];
        let set = |place: usize| place % 3;
        let matrix = DMatrix::from_fn(8, 8, |i, j| {
            let meet = i == j || shared.contains(&i) || shared.contains(&j) || set(i) == set(j);
            f64::from(u8::from(meet))
        });
        let order = order(&matrix);
        assert_eq!(order.own, 6);
        assert_eq!(order.places, [1, 7, 2, 5, 3, 6, 0, 4]);
        let full = DMatrix::from_element(3, 3, 1.0);
        let order = super::order(&full);
        assert_eq!((order.places, order.own), (vec![0, 1, 2], 0));
    }
}
