//! What is wrong with one flight: changes between stick and surface, forces, air, sensors, recorder.

use crate::force::Force;
use crate::motion::{Air, Motion};

/// A surface's deflection over time: from what is commanded, with the time between values.
pub(crate) type SurfaceChange = Box<dyn Fn(&[f64], f64) -> Vec<f64>>;
/// A sensor's reading over time, from what it would read and how the aircraft moves.
pub(crate) type SensorChange = Box<dyn Fn(&[f64], &[Motion], f64) -> Vec<f64>>;
/// Samples as they are recorded, noise included, with the noise's standard deviation.
pub(crate) type RecordChange = Box<dyn Fn(&mut [f64], f64)>;

#[derive(Default)]
pub(crate) struct Plant {
    pub surfaces: Vec<(usize, SurfaceChange)>,
    pub forces: Vec<Box<dyn Force>>,
    pub air: Vec<Box<dyn Fn(f64) -> Air>>,
    /// By name of the channel.
    pub sensors: Vec<(String, SensorChange)>,
    pub records: Vec<(String, RecordChange)>,
    /// Two channels under each other's name.
    pub swapped: Option<(String, String)>,
    /// The recorder's clock runs by this much too fast.
    pub clock: f64,
    /// Added to the steady start, by state.
    pub displaced: Vec<(usize, f64)>,
    /// Share by which the speed changes along the flight of an airframe whose derivatives follow it.
    pub slows_by: Option<f64>,
}

impl Plant {
    pub(crate) fn air_at(&self, time: f64) -> Air {
        self.air.iter().fold(Air::default(), |sum, air| {
            let air = air(time);
            let plus = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|i| a[i] + b[i]);
            Air {
                alpha_rate: sum.alpha_rate + air.alpha_rate,
                beta_rate: sum.beta_rate + air.beta_rate,
                wind: plus(sum.wind, air.wind),
                wind_rate: plus(sum.wind_rate, air.wind_rate),
            }
        })
    }
}
