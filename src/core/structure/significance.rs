//! Which terms of a structure may be there by chance.

use std::f64::consts::SQRT_2;

use statrs::function::erf::erfc;

use super::report::{Structure, Term};

/// Of so many searches among terms of noise alone, one may take a term for significant.
const LEVEL: f64 = 0.05;

impl Structure {
    /// The terms that were kept, the constant not counted, of whose partial F pure noise reaches as much in more than one of 20
    /// searches among as many candidates: N P(|t| > √F) > 0.05 for N candidates (Bonferroni), with many samples.
    pub fn insignificant(&self) -> Vec<&Term> {
        let is_by_chance = |term: &&Term| {
            let probability = two_sided(term.partial_f.sqrt());
            term.term != "1" && self.candidates as f64 * probability > LEVEL
        };
        self.terms.iter().filter(is_by_chance).collect()
    }
}

/// P(|t| > x) of a standard normal t.
fn two_sided(x: f64) -> f64 {
    erfc(x / SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By scipy 1.17: scipy.stats.chi2.sf(F, 1).
    #[test]
    fn probabilities_are_those_of_the_normal_distribution() {
        for (f, exact) in [
            (0.0, 1.0),
            (1.0, 0.317_310_507_9),
            (4.0, 0.045_500_263_9),
            (7.879_438_577, 0.005),
            (12.115_665_15, 0.000_5),
        ] {
            let found = two_sided(f64::sqrt(f));
            assert!((found - exact).abs() < 1e-9, "{f}: {found}");
        }
    }
}
