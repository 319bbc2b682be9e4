//! Stability and control derivatives, dimensional and nondimensional, and the way between the two.
//!
//! With q̄ = ρV²/2, l = c̄ for X, Z, M and b for Y, L, N (Machado, UFMG 2022, tables 1 and 2 and the definitions after
//! eq. 2.14; Nelson, Flight Stability and Automatic Control, 2nd ed., tables 3.5 and 5.1):
//!
//! ```text
//! forces    X_ξ = q̄S/m · k_ξ C_xξ          moments    M_ξ = q̄S l/I · k_ξ C_mξ
//! k_ξ = 1 for angles and deflections, l/(2V) for p, q, r and dα/dt, 1/V for the speed
//! L' = (L + Ixz/Ix N)/(1 - Ixz²/(Ix Iz)),   N' = (N + Ixz/Iz L)/(1 - Ixz²/(Ix Iz))
//! ```
//!
//! Linear models have L' and N' in their equations: those are what `Lb`, `Np`, ... of a model mean here. The derivative
//! by V takes the coefficient to be ∂C/∂(V/V_e) with the 2 C of the dynamic pressure in it. Axes are not turned: body-axis
//! derivatives give body-axis coefficients.

use super::{Aircraft, Dimension, Fault, Unit};

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Axis {
    X,
    Y,
    Z,
    L,
    M,
    N,
}

/// What a force or moment is differentiated by.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum By {
    Speed,
    Rate,
    Angle,
}

/// A derivative by its name: `Ma`, `Zq`, `Ldr`; its coefficient is called `Cma`, `Czq`, `Cldr`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Derivative<'n> {
    axis: Axis,
    /// `a`, `q`, `dr`.
    argument: &'n str,
    by: By,
}

/// How a model writes a force derivative.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Form {
    /// As acceleration.
    Whole,
    /// Divided by the speed.
    OverSpeed,
    /// Divided by the speed, with the kinematic 1 of dα/dt = (1 + Zq/V) q added.
    OverSpeedPlusOne,
}

/// One number as a weighted sum of others.
#[derive(Clone, PartialEq, Debug)]
pub struct WeightedSum {
    /// What the sum is called: `Cma`, `Lb`, ...
    pub name: String,
    /// What is added to the terms, in the unit of the sum.
    pub constant: f64,
    /// (index into what was given, weight)
    pub terms: Vec<(usize, f64)>,
}

impl WeightedSum {
    /// The sum, for the values that the terms' indices point into.
    pub fn value(&self, of: &[f64]) -> f64 {
        self.constant
            + self
                .terms
                .iter()
                .map(|&(i, weight)| weight * of[i])
                .sum::<f64>()
    }
}

impl<'n> Derivative<'n> {
    /// Reads the name of a dimensional derivative; `None` where it is none.
    pub fn parse(name: &'n str) -> Option<Self> {
        let axis = match name.as_bytes().first()? {
            b'X' => Axis::X,
            b'Y' => Axis::Y,
            b'Z' => Axis::Z,
            b'L' => Axis::L,
            b'M' => Axis::M,
            b'N' => Axis::N,
            _ => return None,
        };
        let argument = &name[1..];
        let by = match argument {
            "V" => By::Speed,
            "p" | "q" | "r" | "ad" => By::Rate,
            "a" | "b" | "de" | "da" | "dr" => By::Angle,
            _ => return None,
        };
        Some(Self { axis, argument, by })
    }

    /// `Cma`
    pub fn coefficient(&self) -> String {
        let axis = match self.axis {
            Axis::X => 'x',
            Axis::Y => 'y',
            Axis::Z => 'z',
            Axis::L => 'l',
            Axis::M => 'm',
            Axis::N => 'n',
        };
        format!("C{axis}{}", self.argument)
    }

    /// How a model writes it, told by its unit; `None` where the unit is that of something else.
    fn form(&self, dimension: Dimension) -> Option<Form> {
        let speed = Dimension::METRE.over(Dimension::SECOND);
        let per_second = Dimension::NONE.over(Dimension::SECOND);
        let by = match self.by {
            By::Speed => speed,
            By::Rate => per_second,
            By::Angle => Dimension::NONE,
        };
        let is_moment = matches!(self.axis, Axis::L | Axis::M | Axis::N);
        let of = if is_moment { per_second } else { speed }.over(Dimension::SECOND);
        let whole = of.over(by);
        if dimension == whole {
            Some(Form::Whole)
        } else if is_moment || dimension != whole.over(speed) {
            None
        } else if (self.axis, self.argument) == (Axis::Z, "q") {
            Some(Form::OverSpeedPlusOne)
        } else {
            Some(Form::OverSpeed)
        }
    }

    /// The (unprimed) dimensional derivative for a coefficient of one, whole.
    fn factor(&self, aircraft: &Aircraft) -> Result<f64, Fault> {
        let need = |name: &str, value: Option<f64>| {
            value.ok_or_else(|| {
                let message = format!("{} needs {name}; give it, in SI units", self.coefficient());
                Fault::new(format!("/{name}"), "bad_aircraft", message)
            })
        };
        let length = || match self.axis {
            Axis::X | Axis::Z | Axis::M => need("c", aircraft.c),
            Axis::Y | Axis::L | Axis::N => need("b", aircraft.b),
        };
        let inertia = match self.axis {
            Axis::X | Axis::Y | Axis::Z => need("m", aircraft.m)?,
            Axis::L => need("Ix", aircraft.ix)? / length()?,
            Axis::M => need("Iy", aircraft.iy)? / length()?,
            Axis::N => need("Iz", aircraft.iz)? / length()?,
        };
        let by = match self.by {
            By::Speed => 1.0 / aircraft.speed,
            By::Rate => length()? / (2.0 * aircraft.speed),
            By::Angle => 1.0,
        };
        Ok(aircraft.dynamic_pressure() * aircraft.wing_area / inertia * by)
    }

    /// The derivative of the other moment that Ixz couples it with, and Ixz over the own moment of inertia.
    fn partner(&self, aircraft: &Aircraft) -> Option<(Axis, f64)> {
        let share = |inertia: Option<f64>| inertia.map(|inertia| aircraft.ixz / inertia);
        let (axis, share) = match self.axis {
            Axis::L => (Axis::N, share(aircraft.ix)?),
            Axis::N => (Axis::L, share(aircraft.iz)?),
            _ => return None,
        };
        (share != 0.0).then_some((axis, share))
    }
}

/// Coefficients from the derivatives of a model: each named parameter with the unit the model gives it, values in SI.
/// What is no derivative is passed over; so is a roll or yaw derivative whose partner across Ixz is not there.
///
/// # Errors
/// A constant of the aircraft that is needed and not given.
pub fn coefficients(
    given: &[(&str, Unit)],
    aircraft: &Aircraft,
) -> Result<Vec<WeightedSum>, Fault> {
    let mut sums = Vec::new();
    for (index, &(name, unit)) in given.iter().enumerate() {
        let Some(derivative) = Derivative::parse(name) else {
            continue;
        };
        let Some(form) = derivative.form(unit.dimension) else {
            continue;
        };
        let factor = derivative.factor(aircraft)?;
        let whole = match form {
            Form::Whole => 1.0,
            Form::OverSpeed | Form::OverSpeedPlusOne => aircraft.speed,
        };
        let constant = match form {
            Form::OverSpeedPlusOne => -aircraft.speed / factor,
            Form::Whole | Form::OverSpeed => 0.0,
        };
        let mut terms = vec![(index, whole / factor)];
        if let Some((axis, share)) = derivative.partner(aircraft) {
            let is_partner = |&(name, _): &(&str, Unit)| {
                Derivative::parse(name)
                    .is_some_and(|d| d.axis == axis && d.argument == derivative.argument)
            };
            let Some(partner) = given.iter().position(is_partner) else {
                continue;
            };
            // L = L' - Ixz/Ix N', and likewise for N
            terms.push((partner, -share / factor));
        }
        let name = derivative.coefficient();
        sums.push(WeightedSum {
            name,
            constant,
            terms,
        });
    }
    Ok(sums)
}

/// Derivatives as a model has them (`wanted`: names and units), from named coefficients. What is no derivative, or has
/// no coefficient here, is passed over; a partner across Ixz that is not given counts as zero.
///
/// # Errors
/// A constant of the aircraft that is needed and not given.
pub fn derivatives(
    coefficients: &[&str],
    wanted: &[(&str, Unit)],
    aircraft: &Aircraft,
) -> Result<Vec<WeightedSum>, Fault> {
    let mut sums = Vec::new();
    for &(name, unit) in wanted {
        let Some(derivative) = Derivative::parse(name) else {
            continue;
        };
        let Some(form) = derivative.form(unit.dimension) else {
            continue;
        };
        let place = |d: &Derivative| {
            let name = d.coefficient();
            coefficients.iter().position(|&known| known == name)
        };
        let Some(index) = place(&derivative) else {
            continue;
        };
        let (over, constant) = match form {
            Form::Whole => (1.0, 0.0),
            Form::OverSpeed => (aircraft.speed, 0.0),
            Form::OverSpeedPlusOne => (aircraft.speed, 1.0),
        };
        let mut terms = vec![(index, derivative.factor(aircraft)? / over)];
        if let Some((axis, share)) = derivative.partner(aircraft) {
            let partner = Derivative { axis, ..derivative };
            terms[0].1 /= aircraft.coupling();
            if let Some(index) = place(&partner) {
                let weight = share * partner.factor(aircraft)? / aircraft.coupling();
                terms.push((index, weight));
            }
        }
        sums.push(WeightedSum {
            name: name.to_string(),
            constant,
            terms,
        });
    }
    Ok(sums)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Navion of Nelson's appendix B, in SI: 2750 lb, 184 ft², 33.4 ft, 5.7 ft, 1048, 3000 and 3530 slug ft², 176 ft/s.
    fn navion() -> Aircraft {
        Aircraft {
            m: Some(1247.4),
            wing_area: 17.094,
            c: Some(1.737),
            b: Some(10.18),
            ix: Some(1420.9),
            iy: Some(4067.5),
            iz: Some(4786.0),
            ixz: 0.0,
            speed: 53.64,
            rho: Some(1.225),
            qbar: None,
        }
    }

    fn unit(text: &str) -> Unit {
        Unit::parse(text).expect("a unit")
    }

    /// Nelson works these out for the Navion with three digits in examples 4.3 and 5.3 (there in feet and slugs).
    #[test]
    fn the_published_example_of_the_navion() {
        const FOOT: f64 = 0.3048;
        let published = [
            ("Cza", -(4.44 + 0.05), "Za", "m/s^2", -356.0 * FOOT),
            ("Cma", -0.683, "Ma", "1/s^2", -8.8),
            ("Cmq", -9.96, "Mq", "1/s", -2.05),
            ("Cmad", -4.36, "Mad", "1/s", -0.898),
            ("Cyb", -0.564, "Yb", "1/s", -0.254),
            ("Clb", -0.074, "Lb", "1/s^2", -16.02),
            ("Clp", -0.410, "Lp", "1/s", -8.40),
            ("Clr", 0.107, "Lr", "1/s", 2.19),
            ("Cnb", 0.071, "Nb", "1/s^2", 4.49),
            ("Cnp", -0.0575, "Np", "1/s", -0.350),
            ("Cnr", -0.125, "Nr", "1/s", -0.760),
        ];
        for (coefficient, value, name, of, expected) in published {
            let sums = derivatives(&[coefficient], &[(name, unit(of))], &navion()).expect("sums");
            let found = sums[0].value(&[value]);
            // three printed digits, products of rounded table values
            assert!(
                (found / expected - 1.0).abs() < 0.02,
                "{name}: {found} where {expected} is published"
            );
        }
    }

    #[test]
    fn there_and_back() {
        let mut aircraft = navion();
        aircraft.ixz = 700.0;
        let wanted = [
            ("XV", "1/s"),
            ("Xa", "m/s^2"),
            ("ZV", "1/m"),
            ("Za", "1/s"),
            ("Zq", "-"),
            ("Zde", "1/s"),
            ("MV", "1/(m*s)"),
            ("Ma", "1/s^2"),
            ("Mq", "1/s"),
            ("Yb", "m/s^2"),
            ("Yp", "m/s"),
            ("Ydr", "1/s"),
            ("Lb", "1/s^2"),
            ("Nb", "1/s^2"),
            ("Lp", "1/s"),
            ("Np", "1/s"),
            ("Ldr", "1/s^2"),
            ("Ndr", "1/s^2"),
        ]
        .map(|(name, of)| (name, unit(of)));
        let values: Vec<f64> = (0..wanted.len()).map(|i| 0.3 + 0.7 * i as f64).collect();
        let there = coefficients(&wanted, &aircraft).expect("coefficients");
        let nondimensional: Vec<f64> = there.iter().map(|sum| sum.value(&values)).collect();
        let names: Vec<&str> = there.iter().map(|sum| sum.name.as_str()).collect();
        let back = derivatives(&names, &wanted, &aircraft).expect("derivatives");
        assert_eq!(back.len(), wanted.len());
        for ((sum, value), (name, _)) in back.iter().zip(values).zip(wanted) {
            assert_eq!(sum.name, name);
            let found = sum.value(&nondimensional);
            assert!(
                (found - value).abs() < 1e-12 * value.abs().max(1.0),
                "{name}"
            );
        }
    }

    #[test]
    fn what_is_no_derivative_is_passed_over_and_what_is_needed_is_named() {
        let given = [
            ("V_e", unit("m/s")),
            ("q_bias", unit("rad/s")),
            ("Ma", unit("m")),
        ];
        assert_eq!(coefficients(&given, &navion()), Ok(Vec::new()));
        let mut aircraft = navion();
        aircraft.iy = None;
        let fault = coefficients(&[("Ma", unit("1/s^2"))], &aircraft).expect_err("a fault");
        assert_eq!(
            (fault.pointer.as_str(), &*fault.code),
            ("/Iy", "bad_aircraft")
        );
        // roll and yaw cannot be parted without the partner
        aircraft.ixz = 100.0;
        assert_eq!(
            coefficients(&[("Lp", unit("1/s"))], &aircraft),
            Ok(Vec::new())
        );
        aircraft.ixz = 1e5;
        aircraft.speed = 0.0;
        let pointers: Vec<String> = aircraft.faults().into_iter().map(|f| f.pointer).collect();
        assert_eq!(pointers, ["/V", "/Ixz"]);
    }
}
