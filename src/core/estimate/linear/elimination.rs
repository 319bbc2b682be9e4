//! In which order unknowns are eliminated: those of a maneuver of its own meet no other maneuver's, so that with these
//! first, maneuver by maneuver, and what is shared last, nothing fills in (George and Liu 1981, ch. 4).

use nalgebra::DMatrix;

/// The places of a symmetric matrix, sets that do not meet one another first, then what they share: places that meet
/// more than twice as many as most do. Where there is one set alone, the order is as it was.
pub(crate) fn order(matrix: &DMatrix<f64>) -> Order {
    let n = matrix.nrows();
    let meets = |place: usize| {
        let column = matrix.column(place);
        (0..n).filter(move |&other| column[other] != 0.0)
    };
    let met: Vec<usize> = (0..n).map(|place| meets(place).count()).collect();
    let mut sorted = met.clone();
    sorted.sort_unstable();
    let most = sorted.get(n / 2).copied().unwrap_or(0);
    let is_shared = |place: usize| met[place] > 2 * most;
    let mut is_taken: Vec<bool> = (0..n).map(is_shared).collect();
    let mut sets = 0;
    let mut places = Vec::with_capacity(n);
    for first in 0..n {
        if is_taken[first] {
            continue;
        }
        is_taken[first] = true;
        sets += 1;
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
    if sets <= 1 {
        let places = (0..n).collect();
        return Order { places, own: 0 };
    }
    let own = places.len();
    places.extend((0..n).filter(|&place| is_shared(place)));
    Order { places, own }
}

pub(crate) struct Order {
    pub places: Vec<usize>,
    /// How many come before those that are shared.
    pub own: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_come_one_after_the_other_and_what_they_share_last() {
        let shared = [0, 4];
        let set = |place: usize| place % 5;
        let matrix = DMatrix::from_fn(12, 12, |i, j| {
            let meet = i == j || shared.contains(&i) || shared.contains(&j) || set(i) == set(j);
            f64::from(u8::from(meet))
        });
        let order = order(&matrix);
        assert_eq!(order.own, 10);
        assert_eq!(order.places, [1, 6, 11, 2, 7, 3, 8, 5, 10, 9, 0, 4]);
        let full = DMatrix::from_element(3, 3, 1.0);
        let order = super::order(&full);
        assert_eq!((order.places, order.own), (vec![0, 1, 2], 0));
    }
}
