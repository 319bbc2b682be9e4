//! Positions on the ellipsoid of WGS 84 in metres north and east of the first of them.

/// Semi-major axis, m, and the square of the eccentricity.
const SEMI_MAJOR_AXIS: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;
const ECCENTRICITY_SQUARED: f64 = FLATTENING * (2.0 - FLATTENING);

/// Metres north of the first position that is there. Angles in radians.
pub(super) fn north(latitude: &[f64], longitude: &[f64]) -> Vec<f64> {
    project(latitude, longitude, |frame, offset| frame.north(offset))
}

/// Metres east of it.
pub(super) fn east(latitude: &[f64], longitude: &[f64]) -> Vec<f64> {
    project(latitude, longitude, |frame, offset| frame.east(offset))
}

fn project(
    latitude: &[f64],
    longitude: &[f64],
    along: impl Fn(&Frame, [f64; 3]) -> f64,
) -> Vec<f64> {
    let positions = || latitude.iter().copied().zip(longitude.iter().copied());
    let first = positions().find(|(a, b)| a.is_finite() && b.is_finite());
    let Some((latitude, longitude)) = first else {
        return vec![f64::NAN; latitude.len()];
    };
    let frame = Frame::at(latitude, longitude);
    let of = |(latitude, longitude)| {
        let there = from_centre(latitude, longitude);
        along(&frame, std::array::from_fn(|i| there[i] - frame.origin[i]))
    };
    positions().map(of).collect()
}

/// From the centre of the earth: towards 0° east on the equator, 90° east, the north pole.
fn from_centre(latitude: f64, longitude: f64) -> [f64; 3] {
    let sine = latitude.sin();
    let radius = SEMI_MAJOR_AXIS / (1.0 - ECCENTRICITY_SQUARED * sine * sine).sqrt();
    [
        radius * latitude.cos() * longitude.cos(),
        radius * latitude.cos() * longitude.sin(),
        radius * (1.0 - ECCENTRICITY_SQUARED) * sine,
    ]
}

/// The plane that touches the ellipsoid at a position.
struct Frame {
    origin: [f64; 3],
    latitude: f64,
    longitude: f64,
}

impl Frame {
    fn at(latitude: f64, longitude: f64) -> Self {
        Self {
            origin: from_centre(latitude, longitude),
            latitude,
            longitude,
        }
    }

    fn north(&self, [x, y, z]: [f64; 3]) -> f64 {
        let outwards = x * self.longitude.cos() + y * self.longitude.sin();
        z * self.latitude.cos() - outwards * self.latitude.sin()
    }

    fn east(&self, [x, y, _]: [f64; 3]) -> f64 {
        y * self.longitude.cos() - x * self.longitude.sin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small differences are those on the radii of curvature, in the closed forms of geodesy.
    #[test]
    fn small_differences_are_arcs() {
        for latitude in [-0.9f64, 0.0, 0.7, 1.2] {
            let (step, sine) = (1e-6, latitude.sin());
            let root = (1.0 - ECCENTRICITY_SQUARED * sine * sine).sqrt();
            let meridian = SEMI_MAJOR_AXIS * (1.0 - ECCENTRICITY_SQUARED) / root.powi(3);
            let normal = SEMI_MAJOR_AXIS / root;
            let latitudes = [f64::NAN, latitude, latitude + step, latitude];
            let longitudes = [0.1, 0.1, 0.1, 0.1 + step];
            let north = north(&latitudes, &longitudes);
            let east = east(&latitudes, &longitudes);
            assert!(north[0].is_nan() && east[0].is_nan());
            assert!((north[2] - meridian * step).abs() < 1e-5, "{}", north[2]);
            assert!(
                (east[3] - normal * latitude.cos() * step).abs() < 1e-5,
                "{}",
                east[3]
            );
            assert!(
                north[1] == 0.0 && east[1] == 0.0 && north[3].abs() < 1e-5 && east[2].abs() < 1e-8
            );
        }
    }

    #[test]
    fn the_date_line_is_no_jump() {
        let step = 0.01f64.to_radians();
        let longitudes = [std::f64::consts::PI - step, step - std::f64::consts::PI];
        let east = east(&[0.5, 0.5], &longitudes);
        assert!((1900.0..2000.0).contains(&east[1]), "{}", east[1]);
        assert!(north(&[f64::NAN], &[1.0])[0].is_nan());
    }
}
