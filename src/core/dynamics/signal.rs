//! Signals that go into a linear system and come out of it.

use num_complex::Complex64;

use crate::flight::PhysicalQuantity;
use crate::model::Element;

/// An input or output of a linear system.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Signal {
    pub name: String,
    /// SI, as the field writes it.
    pub unit: String,
    pub quantity: Option<PhysicalQuantity>,
    /// Lag and delay on its way, as places among the sizes of all paths.
    pub path: Vec<(Element, usize)>,
}

impl Signal {
    /// The place of an element's size, where the signal passes one.
    pub(super) fn place_of(&self, element: Element) -> Option<usize> {
        let mut path = self.path.iter();
        path.find_map(|&(other, place)| (other == element).then_some(place))
    }

    /// Whether it passes something that no linear system has.
    pub(super) fn is_nonlinear(&self) -> bool {
        let linear = [Element::Lag, Element::Delay];
        self.path
            .iter()
            .any(|(element, _)| !linear.contains(element))
    }

    /// ln of the response of its path at jω, and its derivatives by the sizes of the path's elements, by place.
    pub(super) fn path_response(
        &self,
        sizes: &[f64],
        omega: f64,
    ) -> (Complex64, Vec<(usize, Complex64)>) {
        let mut sum = Complex64::ZERO;
        let mut slopes = Vec::new();
        for &(element, place) in &self.path {
            let Some((value, slope)) = element_response(element, sizes[place], omega) else {
                continue;
            };
            sum += value;
            slopes.push((place, slope));
        }
        (sum, slopes)
    }
}

/// ln H(jω) of an element and its derivative by the element's size: a delay is e^(−jωτ), a lag 1/(1 + jωT), and below zero
/// it leads by what it would lag. None of what is not linear.
fn element_response(element: Element, size: f64, omega: f64) -> Option<(Complex64, Complex64)> {
    let j_omega = Complex64::new(0.0, omega);
    match element {
        Element::Delay => Some((-j_omega * size, -j_omega)),
        Element::Lag => {
            let lag = (1.0 + j_omega * size.abs()).inv();
            let response = if size < 0.0 { 2.0 - lag } else { lag };
            // both sides of zero have the same derivative by T
            Some((response.ln(), -j_omega * lag * lag / response))
        }
        Element::Play | Element::RateLimit => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against differences.
    #[test]
    fn slopes_of_elements_are_those_of_differences() {
        const STEP: f64 = 1e-6;
        for element in [Element::Delay, Element::Lag] {
            for size in [0.3, 0.0, -0.2] {
                let at = |size: f64| element_response(element, size, 2.5).expect("linear");
                let difference = (at(size + STEP).0 - at(size - STEP).0) / (2.0 * STEP);
                let slope = at(size).1;
                assert!((difference - slope).norm() < 1e-5, "{element:?} of {size}");
            }
        }
        assert_eq!(element_response(Element::Play, 0.1, 1.0), None);
    }
}
