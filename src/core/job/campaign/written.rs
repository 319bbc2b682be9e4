//! A curve as people read it.

use indexmap::IndexMap;

use super::report::{CampaignCurve, CampaignPoint, CampaignTerm};
use crate::flight::{two_digits, with_digits, with_error};

/// Digits of a coefficient, at least and at most.
const DIGITS: [f64; 2] = [5.0, 15.0];
/// What rounding may move a curve by, in its standard errors.
const MOVED: f64 = 0.1;

impl CampaignCurve {
    /// The terms with their standard errors: of the parameter times `scale`, over its one condition times `wide`. A mean has the
    /// digits that its error leaves. Coefficients of a curve have more: their errors are correlated, and the curve is known better
    /// than each of them.
    pub fn written(&self, scale: f64, wide: f64) -> String {
        let digits = self.digits();
        let scaled = |term: &CampaignTerm| {
            let scale = scale / wide.powi(term.power());
            [term.value * scale, term.standard_error * scale]
        };
        let text = |term: &CampaignTerm| match scaled(term) {
            [value, error] if self.terms.len() == 1 => with_error(value, error),
            [value, error] => format!("{} ± {}", with_digits(value, digits), two_digits(error)),
        };
        let summand = |term: &CampaignTerm| match term.term.as_str() {
            "1" => text(term),
            name => format!("({}) {name}", text(term)),
        };
        let summands: Vec<String> = self.terms.iter().map(summand).collect();
        summands.join(" + ")
    }

    /// Enough that the sum of the rounded terms is the curve at each point, but for a tenth of its standard error there. A number of
    /// n digits is wrong by at most 5·10⁻ⁿ of itself.
    fn digits(&self) -> u8 {
        let of = |point: &CampaignPoint| {
            let sizes = self
                .terms
                .iter()
                .map(|term| term.at(&point.conditions).abs());
            let moved = MOVED * point.curve_standard_error;
            (5.0 * sizes.sum::<f64>() / moved).log10().ceil()
        };
        let [least, most] = DIGITS;
        self.points.iter().map(of).fold(least, f64::max).min(most) as u8
    }

    /// χ², or why there is none that would test anything: it is rounding then.
    ///
    /// # Errors
    /// There are no degrees of freedom.
    pub fn tested(&self) -> Result<f64, &'static str> {
        match self.degrees_of_freedom {
            0 => Err("untested: no more jobs than terms"),
            _ => Ok(self.chi_squared),
        }
    }
}

impl CampaignTerm {
    /// Of a term in one condition: `1`, `alpha`, `alpha^2`.
    pub fn power(&self) -> i32 {
        match self.term.rsplit_once('^') {
            Some((_, power)) => power.parse().unwrap_or(1),
            None => i32::from(self.term != "1"),
        }
    }

    /// What it adds to the curve at a place, which has the conditions in the order of the question.
    fn at(&self, conditions: &IndexMap<String, f64>) -> f64 {
        let (mut rest, mut product) = (self.term.as_str(), self.value);
        for (name, value) in conditions {
            let Some(behind) = rest.strip_prefix(name.as_str()) else {
                continue;
            };
            let (power, further) = behind.split_once('*').unwrap_or((behind, ""));
            match power.strip_prefix('^') {
                Some(power) => product *= value.powi(power.parse().unwrap_or(1)),
                None if power.is_empty() => product *= value,
                // the name goes on: it is another's
                None => continue,
            }
            rest = further;
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over `x`, with points there whose curve has those standard errors.
    fn curve(terms: &[(&str, f64, f64)], points: &[(f64, f64)]) -> CampaignCurve {
        let term = |&(name, value, standard_error): &(&str, f64, f64)| CampaignTerm {
            term: name.to_string(),
            value,
            standard_error,
        };
        let point = |&(x, curve_standard_error): &(f64, f64)| CampaignPoint {
            job: String::new(),
            name: String::new(),
            conditions: IndexMap::from([("x".to_string(), x)]),
            estimate: 0.0,
            standard_error: 1.0,
            curve: 0.0,
            curve_standard_error,
            deviation: 0.0,
            is_outlier: false,
        };
        CampaignCurve {
            parameter: "Za".into(),
            unit: "1/s".into(),
            group: IndexMap::new(),
            terms: terms.iter().map(term).collect(),
            terms_left_out: Vec::new(),
            chi_squared: 1e-12,
            degrees_of_freedom: 0,
            probability: None,
            scatter: 1.0,
            points: points.iter().map(point).collect(),
        }
    }

    /// Reads `a ± b + (c ± d) x + (e ± f) x^2` as a person does who wants a value of the curve.
    fn value(written: &str, x: f64) -> f64 {
        let term = |term: &str| -> f64 {
            let value = term.trim_start_matches('(').split(" ± ").next();
            let value: f64 = value.expect("a value").parse().expect("a number");
            let power = match term.rsplit_once(") ") {
                None => 0,
                Some((_, "x")) => 1,
                Some((_, "x^2")) => 2,
                Some(other) => panic!("{other:?}"),
            };
            value * x.powi(power)
        };
        written.split(" + ").map(term).sum()
    }

    /// An intercept far from where was flown has a large error, and so has the slope; the curve is at −0.71 all the same.
    #[test]
    fn a_curve_has_the_value_that_its_terms_make() {
        let line = curve(&[("1", 1.31, 35.0), ("x", -0.5643, 10.0)], &[]);
        let written = line.written(1.0, 1.0);
        assert_eq!(written, "1.3100 ± 35 + (-0.56430 ± 10) x");
        assert!((value(&written, 3.58) + 0.71).abs() < 1e-3, "{written}");
    }

    /// Over a narrow stretch far from zero terms nearly cancel: here 1097.9, 2193.6 and 1097.5 at 290.
    #[test]
    fn far_from_zero_the_curve_keeps_a_tenth_of_its_error() {
        let terms = [
            ("1", 1_097.9, 40.0),
            ("x", -7.564_128_3, 0.3),
            ("x^2", 0.013_049_84, 0.000_5),
        ];
        let exact = |x: f64| 1_097.9 - 7.564_128_3 * x + 0.013_049_84 * x * x;
        let points = [286.0, 290.0, 294.0].map(|x| (x, 0.01));
        let parabola = curve(&terms, &points);
        let degree = 1_f64.to_degrees();
        for wide in [1.0, degree] {
            let written = parabola.written(2.0, wide);
            for (x, error) in points {
                let moved = value(&written, x * wide) - 2.0 * exact(x);
                assert!(moved.abs() < 0.1 * 2.0 * error, "{written}: {moved}");
            }
        }
    }

    #[test]
    fn terms_of_several_conditions_are_told_apart() {
        let conditions = IndexMap::from([("a".into(), 2.0), ("ab".into(), 3.0), ("c".into(), 5.0)]);
        for (term, product) in [
            ("1", 7.0),
            ("a^2*c", 140.0),
            ("ab", 21.0),
            ("ab^2*c", 315.0),
            ("a*ab", 42.0),
        ] {
            let term = CampaignTerm {
                term: term.into(),
                value: 7.0,
                standard_error: 1.0,
            };
            assert_eq!(term.at(&conditions), product, "{}", term.term);
        }
    }

    #[test]
    fn a_mean_has_the_digits_that_its_error_leaves() {
        let mean = curve(&[("1", 1.31, 0.35)], &[(4.0, 0.35)]);
        assert_eq!(mean.written(2.0, 1.0), "2.62 ± 0.70");
        assert!(mean.tested().is_err());
    }
}
