//! Aircraft constants and flight condition, as far as derivatives need them.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::Fault;

/// Mass, geometry, inertia, and the steady flight, SI. What the derivatives at hand do not need may be absent.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Aircraft {
    /// Mass, kg.
    #[schema(example = 1247.4)]
    pub m: Option<f64>,
    /// Wing area, m².
    #[serde(rename = "S")]
    #[schema(example = 17.094)]
    pub wing_area: f64,
    /// Mean aerodynamic chord, m.
    #[schema(example = 1.737)]
    pub c: Option<f64>,
    /// Wing span, m.
    #[schema(example = 10.18)]
    pub b: Option<f64>,
    /// Moment of inertia in roll, kg m².
    #[serde(rename = "Ix")]
    #[schema(example = 1420.9)]
    pub ix: Option<f64>,
    /// Moment of inertia in pitch, kg m².
    #[serde(rename = "Iy")]
    #[schema(example = 4067.5)]
    pub iy: Option<f64>,
    /// Moment of inertia in yaw, kg m².
    #[serde(rename = "Iz")]
    #[schema(example = 4786.0)]
    pub iz: Option<f64>,
    /// Product of inertia, kg m².
    #[serde(rename = "Ixz", default)]
    #[schema(example = 0.0)]
    pub ixz: f64,
    /// True airspeed of the steady flight, m/s.
    #[serde(rename = "V")]
    #[schema(example = 53.64)]
    pub speed: f64,
    /// Air density, kg/m³; or give `qbar`.
    #[schema(example = 1.225)]
    pub rho: Option<f64>,
    /// Dynamic pressure, Pa; or give `rho`.
    pub qbar: Option<f64>,
}

impl Aircraft {
    /// Dynamic pressure, Pa.
    pub fn dynamic_pressure(&self) -> f64 {
        match (self.qbar, self.rho) {
            (Some(qbar), _) => qbar,
            (None, rho) => 0.5 * rho.unwrap_or(f64::NAN) * self.speed * self.speed,
        }
    }

    /// 1 - Ixz²/(Ix Iz); one where there is no product of inertia.
    pub(super) fn coupling(&self) -> f64 {
        match (self.ix, self.iz) {
            (Some(ix), Some(iz)) => 1.0 - self.ixz * self.ixz / (ix * iz),
            _ => 1.0,
        }
    }

    /// What is wrong with the numbers, each with its pointer.
    pub fn faults(&self) -> Vec<Fault> {
        let all = [
            ("m", self.m),
            ("S", Some(self.wing_area)),
            ("c", self.c),
            ("b", self.b),
            ("Ix", self.ix),
            ("Iy", self.iy),
            ("Iz", self.iz),
            ("V", Some(self.speed)),
            ("rho", self.rho),
            ("qbar", self.qbar),
        ];
        let bad = |number: f64| !(number > 0.0 && number < 1e12);
        let mut faults: Vec<Fault> = (all.into_iter())
            .filter(|(_, value)| value.is_some_and(bad))
            .map(|(name, value)| {
                let value = value.unwrap_or_default();
                let message = format!("{name} is {value}; it must be above 0, in SI units");
                Fault::new(format!("/{name}"), "bad_aircraft", message)
            })
            .collect();
        if self.rho.is_some() == self.qbar.is_some() {
            let message =
                "give either rho, the air density in kg/m^3, or qbar, the dynamic pressure in Pa";
            faults.push(Fault::new("/rho", "bad_aircraft", message));
        }
        let needs_both = self.ixz != 0.0 && (self.ix.is_none() || self.iz.is_none());
        if needs_both || !(self.ixz.abs() < 1e12 && self.coupling() > 0.0) {
            let message = "Ixz needs Ix and Iz beside it, and Ixz^2 below Ix*Iz";
            faults.push(Fault::new("/Ixz", "bad_aircraft", message));
        }
        faults
    }
}
