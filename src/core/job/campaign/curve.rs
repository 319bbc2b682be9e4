//! A polynomial through values with errors, and the values that lie too far from it.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::report::CampaignTerm;

/// A value with its standard error, where it was flown.
#[derive(Clone, Debug)]
pub(super) struct Observation {
    pub conditions: Vec<f64>,
    pub value: f64,
    pub error: f64,
}

/// How often a campaign without outliers may name one.
const FALSE_ALARMS: f64 = 0.05;
/// No more than this share are outliers: beyond it the curve is no curve of theirs.
const MOST_OUTLIERS: f64 = 0.25;
/// Singular values below this share of the largest do not tell a term.
const RANK: f64 = 1e-8;

/// A polynomial with what it is worth.
pub(super) struct Curve {
    names: Vec<String>,
    powers: Vec<Vec<u32>>,
    solved: Solved,
    pub chi_squared: f64,
    pub degrees_of_freedom: usize,
    /// √(χ²/ν), not below 1.
    pub scatter: f64,
    /// By observation: from the curve that the others make, in standard errors.
    pub deviations: Vec<f64>,
    pub is_outlier: Vec<bool>,
}

/// Coefficients over centred and scaled conditions, and their covariance without the scatter.
#[derive(Clone)]
struct Solved {
    middle: Vec<f64>,
    size: Vec<f64>,
    coefficients: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl Curve {
    /// Of the highest degree, up to `degree`, that the conditions tell; none without observations.
    pub(super) fn fit(
        observations: &[Observation],
        names: &[String],
        degree: usize,
    ) -> Option<Self> {
        if observations.is_empty() {
            return None;
        }
        let mut degrees = (0..=degree).rev();
        let powers = degrees.find_map(|degree| {
            let powers = powers(names.len(), degree);
            // one degree of freedom is left, but for a mean
            let is_enough = degree == 0 || observations.len() > powers.len();
            let all: Vec<&Observation> = observations.iter().collect();
            (is_enough && solve(&all, &powers).is_some()).then_some(powers)
        })?;
        let mut is_outlier = vec![false; observations.len()];
        let most = (MOST_OUTLIERS * observations.len() as f64) as usize;
        for _ in 0..most {
            match worst(observations, &is_outlier, &powers) {
                Some(index) => is_outlier[index] = true,
                None => break,
            }
        }
        let counted = counted(observations, &is_outlier);
        let solved = solve(&counted, &powers)?;
        let chi_squared = chi_squared(&counted, &solved, &powers);
        let degrees_of_freedom = counted.len() - powers.len();
        let scatter = match degrees_of_freedom {
            0 => 1.0,
            freedom => (chi_squared / freedom as f64).sqrt().max(1.0),
        };
        let deviations = (0..observations.len())
            .map(|index| deviation(observations, &is_outlier, index, &powers).unwrap_or_default())
            .collect();
        Some(Self {
            names: names.to_vec(),
            powers,
            solved,
            chi_squared,
            degrees_of_freedom,
            scatter,
            deviations,
            is_outlier,
        })
    }

    /// The curve at some conditions, and its standard error, widened by the scatter.
    pub(super) fn at(&self, conditions: &[f64]) -> (f64, f64) {
        let (value, variance) = self.solved.at(conditions, &self.powers);
        (value, self.scatter * variance.sqrt())
    }

    /// The terms in the conditions themselves.
    pub(super) fn terms(&self) -> Vec<CampaignTerm> {
        let shift = self.solved.in_own_conditions(&self.powers);
        let coefficients = &shift * &self.solved.coefficients;
        let covariance = &shift * &self.solved.covariance * shift.transpose();
        let term = |(place, powers): (usize, &Vec<u32>)| CampaignTerm {
            term: self.name(powers),
            value: coefficients[place],
            standard_error: self.scatter * covariance[(place, place)].max(0.0).sqrt(),
        };
        self.powers.iter().enumerate().map(term).collect()
    }

    fn name(&self, powers: &[u32]) -> String {
        let factor = |(name, power): (&String, &u32)| match power {
            0 => None,
            1 => Some(name.clone()),
            power => Some(format!("{name}^{power}")),
        };
        let factors: Vec<String> = self.names.iter().zip(powers).filter_map(factor).collect();
        match factors.is_empty() {
            true => "1".to_string(),
            false => factors.join("*"),
        }
    }
}

/// The powers of all monomials up to a degree, the constant first.
fn powers(conditions: usize, degree: usize) -> Vec<Vec<u32>> {
    let mut all = vec![vec![0; conditions]];
    let mut last = all.clone();
    for _ in 0..degree {
        let mut next: Vec<Vec<u32>> = Vec::new();
        for powers in &last {
            for condition in 0..conditions {
                let mut more = powers.clone();
                more[condition] += 1;
                if !next.contains(&more) {
                    next.push(more);
                }
            }
        }
        all.extend(next.clone());
        last = next;
    }
    all
}

fn counted<'o>(observations: &'o [Observation], is_outlier: &[bool]) -> Vec<&'o Observation> {
    let all = observations.iter().zip(is_outlier);
    all.filter(|(_, is_outlier)| !**is_outlier)
        .map(|(o, _)| o)
        .collect()
}

fn solve(observations: &[&Observation], powers: &[Vec<u32>]) -> Option<Solved> {
    if observations.len() < powers.len() {
        return None;
    }
    let count = observations[0].conditions.len();
    let over = |condition: usize| observations.iter().map(move |o| o.conditions[condition]);
    let middle: Vec<f64> = (0..count)
        .map(|c| over(c).sum::<f64>() / observations.len() as f64)
        .collect();
    let size: Vec<f64> = (0..count)
        .map(|c| over(c).map(|x| (x - middle[c]).abs()).fold(0.0, f64::max))
        .map(|size| if size > 0.0 { size } else { 1.0 })
        .collect();
    let mut solved = Solved {
        middle,
        size,
        coefficients: DVector::zeros(powers.len()),
        covariance: DMatrix::zeros(powers.len(), powers.len()),
    };
    let row = |o: &Observation| solved.basis(&o.conditions, powers) / o.error;
    let rows: Vec<DVector<f64>> = observations.iter().map(|o| row(o)).collect();
    let weighted = DMatrix::from_columns(&rows).transpose();
    let values = DVector::from_iterator(rows.len(), observations.iter().map(|o| o.value / o.error));
    let svd = weighted.svd(true, true);
    let largest = svd.singular_values.max();
    // written so that NaN is none
    let is_told = svd.singular_values.min() > RANK * largest;
    if !is_told {
        return None;
    }
    solved.coefficients = svd.solve(&values, 0.0).ok()?;
    let right = svd.v_t.as_ref()?;
    let inverse = DMatrix::from_diagonal(&svd.singular_values.map(|s| (s * s).recip()));
    solved.covariance = right.transpose() * inverse * right;
    Some(solved)
}

impl Solved {
    fn basis(&self, conditions: &[f64], powers: &[Vec<u32>]) -> DVector<f64> {
        let scaled: Vec<f64> = (conditions.iter().zip(&self.middle).zip(&self.size))
            .map(|((x, middle), size)| (x - middle) / size)
            .collect();
        let monomial = |powers: &Vec<u32>| -> f64 {
            scaled
                .iter()
                .zip(powers)
                .map(|(x, power)| x.powi(*power as i32))
                .product()
        };
        DVector::from_iterator(powers.len(), powers.iter().map(monomial))
    }

    /// Value and variance.
    fn at(&self, conditions: &[f64], powers: &[Vec<u32>]) -> (f64, f64) {
        let basis = self.basis(conditions, powers);
        let variance = basis.dot(&(&self.covariance * &basis)).max(0.0);
        (basis.dot(&self.coefficients), variance)
    }

    /// From coefficients over scaled conditions to those over the conditions themselves: Π ((x − m)/s)^p multiplied out.
    fn in_own_conditions(&self, powers: &[Vec<u32>]) -> DMatrix<f64> {
        let choose = |n: u32, k: u32| -> f64 {
            (0..k)
                .map(|i| f64::from(n - i) / f64::from(i + 1))
                .product()
        };
        DMatrix::from_fn(powers.len(), powers.len(), |to, from| {
            let factors = powers[to].iter().zip(&powers[from]).enumerate();
            let factor = |(c, (&kept, &power)): (usize, (&u32, &u32))| match kept <= power {
                false => 0.0,
                true => {
                    let rest = (power - kept) as i32;
                    choose(power, kept) * (-self.middle[c]).powi(rest)
                        / self.size[c].powi(power as i32)
                }
            };
            factors.map(factor).product()
        })
    }
}

fn chi_squared(observations: &[&Observation], solved: &Solved, powers: &[Vec<u32>]) -> f64 {
    let off = |o: &&Observation| (o.value - solved.at(&o.conditions, powers).0) / o.error;
    observations.iter().map(|o| off(o).powi(2)).sum()
}

/// How far an observation is from the curve of the others that count, in standard errors of the difference, these widened by
/// the others' scatter; none where the others make no curve.
fn deviation(
    observations: &[Observation],
    is_outlier: &[bool],
    index: usize,
    powers: &[Vec<u32>],
) -> Option<f64> {
    let (solved, freedom, chi_squared) = without(observations, is_outlier, index, powers)?;
    let own = &observations[index];
    let (value, variance) = solved.at(&own.conditions, powers);
    let scatter = match freedom {
        0 => 1.0,
        freedom => (chi_squared / freedom as f64).sqrt().max(1.0),
    };
    Some((own.value - value) / (scatter * (own.error * own.error + variance).sqrt()))
}

fn without(
    observations: &[Observation],
    is_outlier: &[bool],
    index: usize,
    powers: &[Vec<u32>],
) -> Option<(Solved, usize, f64)> {
    let mut left_out = is_outlier.to_vec();
    left_out[index] = true;
    let others = counted(observations, &left_out);
    let solved = solve(&others, powers)?;
    let chi_squared = chi_squared(&others, &solved, powers);
    Some((solved, others.len() - powers.len(), chi_squared))
}

/// The observation that is farthest from the curve of the others, if that is improbable among so many (Bonferroni).
fn worst(observations: &[Observation], is_outlier: &[bool], powers: &[Vec<u32>]) -> Option<usize> {
    let counted: Vec<usize> = (0..observations.len())
        .filter(|&i| !is_outlier[i])
        .collect();
    let tail = 1.0 - 0.5 * FALSE_ALARMS / counted.len() as f64;
    let of = |&index: &usize| {
        let far = deviation(observations, is_outlier, index, powers)?.abs();
        let (_, freedom, chi_squared) = without(observations, is_outlier, index, powers)?;
        // a scatter that was found from few is no better known than that
        let limit = match freedom {
            0 => return None,
            freedom if chi_squared > freedom as f64 => StudentsT::new(0.0, 1.0, freedom as f64)
                .ok()?
                .inverse_cdf(tail),
            _ => Normal::new(0.0, 1.0).ok()?.inverse_cdf(tail),
        };
        (far > limit).then_some((far, index))
    };
    let beyond = counted.iter().filter_map(of);
    beyond
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, index)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observation(x: f64, value: f64, error: f64) -> Observation {
        Observation {
            conditions: vec![x],
            value,
            error,
        }
    }

    /// 3 and 5 with errors 1 and 2: weights 1 and 1/4, mean 3.4, error sqrt(0.8), χ² = 0.8.
    #[test]
    fn a_curve_of_degree_zero_is_the_weighted_mean() {
        let all = [observation(0.0, 3.0, 1.0), observation(0.0, 5.0, 2.0)];
        let curve = Curve::fit(&all, &["x".to_string()], 2).expect("a curve");
        assert_eq!(curve.powers, [[0]]);
        let (value, error) = curve.at(&[7.0]);
        assert!((value - 3.4).abs() < 1e-12 && (error - 0.8_f64.sqrt()).abs() < 1e-12);
        assert!((curve.chi_squared - 0.8).abs() < 1e-12);
        assert_eq!(curve.is_outlier, [false, false]);
    }

    /// Terms over the conditions themselves, far from zero as Mach numbers times a thousand are.
    #[test]
    fn a_parabola_has_its_own_coefficients() {
        let parabola = |x: f64| 2.0 - 0.3 * x + 0.01 * x * x;
        let all: Vec<Observation> = (0..8)
            .map(|k| 100.0 + f64::from(k))
            .map(|x| observation(x, parabola(x), 0.1))
            .collect();
        let curve = Curve::fit(&all, &["x".to_string()], 2).expect("a curve");
        let terms = curve.terms();
        let names: Vec<&str> = terms.iter().map(|term| term.term.as_str()).collect();
        assert_eq!(names, ["1", "x", "x^2"]);
        for (term, expected) in terms.iter().zip([2.0, -0.3, 0.01]) {
            assert!(
                (term.value - expected).abs() < 1e-6 * expected.abs(),
                "{term:?}"
            );
        }
    }

    #[test]
    fn what_lies_far_from_the_others_is_named_and_does_not_count() {
        let mut all: Vec<Observation> = (0..12)
            .map(|k| observation(f64::from(k), f64::from(k) + 0.5 * f64::from(k % 3 - 1), 0.5))
            .collect();
        all[4].value += 6.0;
        all[9].value -= 4.0;
        let curve = Curve::fit(&all, &["x".to_string()], 1).expect("a curve");
        let outliers: Vec<usize> = (0..12).filter(|&i| curve.is_outlier[i]).collect();
        assert_eq!(outliers, [4, 9]);
        assert!(curve.deviations[4] > 6.0 && curve.deviations[9] < -4.0);
    }
}
