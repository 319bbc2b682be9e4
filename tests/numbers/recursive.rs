//! Estimates in flight: against an independent computation, against batches, against known truth.

use serde_json::{Value, json};
use trimtab_core::estimate::Estimate;
use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, Limits, read};
use trimtab_core::job::Plan;
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::recursive::{
    Estimates, Sample, SampleFault, Setup, Tracker, TrackingMethod, TrackingOptions,
};
use trimtab_core::simulate::{Scenario, Segment};

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::common::plans::plan;

const NAMES: [&str; 6] = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"];

fn recorded() -> Arc<Maneuver> {
    let text = include_bytes!("../../data/elevator.csv");
    Arc::new(read(text, Format::Csv, &Limits::default()).expect("a recording"))
}

/// data/elevator.toml or another, flown with a seed.
fn flown(scenario: &str, seed: u64) -> Arc<Maneuver> {
    let scenario: Scenario = toml::from_str(scenario).expect("a scenario");
    let document = catalog::find(&scenario.model).expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    let maneuver = Scenario { seed, ..scenario }.fly(&model);
    Arc::new(maneuver.expect("a maneuver"))
}

fn options(value: Value) -> TrackingOptions {
    serde_json::from_value(value).expect("options")
}

fn tracker(plan: &Plan, asked: Value) -> Tracker {
    let setup = Setup::of_problem(&plan.problem).expect("a segment");
    Tracker::new(&setup, &options(asked)).unwrap_or_else(|faults| panic!("{faults}"))
}

fn push<'t>(
    tracker: &'t mut Tracker,
    segment: &Segment,
    k: usize,
) -> Result<&'t Estimates, SampleFault> {
    let at =
        |series: &Vec<Vec<f64>>| -> Vec<f64> { series.iter().map(|values| values[k]).collect() };
    let (inputs, outputs) = (at(&segment.inputs), at(&segment.measured));
    tracker.push(&Sample {
        time: segment.time[k],
        inputs: &inputs,
        outputs: &outputs,
    })
}

/// After all samples of a plan's first segment.
fn tracked(plan: &Plan, asked: Value) -> (Tracker, Estimates) {
    let mut tracker = tracker(plan, asked);
    let segment = &plan.problem.segments[0];
    for k in 0..segment.len() {
        push(&mut tracker, segment, k).expect("a sample");
    }
    let found = tracker.finish().clone();
    (tracker, found)
}

fn place(tracker: &Tracker, name: &str) -> usize {
    let mut all = tracker.parameters().iter();
    all.position(|parameter| parameter.name == name)
        .expect("it is followed")
}

fn elevator(maneuver: Arc<Maneuver>, changes: Value) -> Plan {
    plan(json!("short-period"), changes, &[maneuver])
}

/// The start values of the filter in tests/python/recursive.py, and its other settings.
fn known_starts() -> Value {
    json!({"parameters": {"alpha_eq": {"start": 0.06}, "de_eq": {"start": -0.02}, "alpha_0": {"start": 0.06}}})
}

fn filter() -> Value {
    let deg = std::f64::consts::PI / 180.0;
    json!({"method": "ekf", "noise": {"alpha": 0.05 * deg, "q": 0.08 * deg}, "uncertainty": {"q_bias": 0.005}})
}

fn with(mut value: Value, more: Value) -> Value {
    for (key, own) in more.as_object().expect("an object") {
        value[key] = own.clone();
    }
    value
}

/// By numpy 2.4 and scipy 1.17 (tests/python/recursive.py): a Savitzky-Golay filter and weighted least squares of all rows at once;
/// Gauss-Legendre quadrature of the weighted signals and complex least squares; a dense filter whose Φ comes from complex steps.
#[test]
fn estimates_are_those_of_an_independent_computation() {
    let band = json!({"method": "rft", "frequency": {"band_hz": [0.1, 1.5], "step_hz": 0.04}});
    let cases: [(&str, Value, f64, [[f64; 6]; 2]); 6] = [
        ("rls", json!({"method": "rls"}), 1e-6, RLS),
        (
            "rls 0.99",
            json!({"method": "rls", "forgetting": 0.99}),
            1e-6,
            RLS_99,
        ),
        ("rft", band.clone(), 1e-6, RFT),
        // the corrections of the ends are those of a transform that forgets nothing
        (
            "rft 0.998",
            with(band, json!({"forgetting": 0.998})),
            2e-2,
            RFT_998,
        ),
        ("ekf", filter(), 1e-6, EKF),
        (
            "ekf 0.998",
            with(filter(), json!({"forgetting": 0.998, "drift": {"Ma": 0.1}})),
            1e-6,
            EKF_998,
        ),
    ];
    let plan = elevator(recorded(), known_starts());
    for (what, asked, tolerance, [values, errors]) in cases {
        let (tracker, found) = tracked(&plan, asked);
        for ((name, value), error) in NAMES.iter().zip(values).zip(errors) {
            let at = place(&tracker, name);
            let (own, bound) = (found.values[at], found.standard_errors[at]);
            println!("{what} {name}: {own} ± {bound}, {value} ± {error}");
            assert!(
                (own - value).abs() < tolerance * error,
                "{what} {name}: {own}, {value}"
            );
            assert!(
                (bound / error - 1.0).abs() < tolerance.max(1e-5),
                "{what} {name}: {bound}, {error}"
            );
        }
    }
    let mut tracker = tracker(&plan, json!({"method": "rls", "forgetting": 0.99}));
    for k in 0..400 {
        push(&mut tracker, &plan.problem.segments[0], k).expect("a sample");
    }
    let found = tracker.estimates();
    let last = plan.problem.segments[0].time[395];
    assert_eq!(
        (found.samples, found.time),
        (396, last),
        "late by half a window"
    );
    for ((name, value), error) in NAMES
        .iter()
        .zip(RLS_99_AFTER_400[0])
        .zip(RLS_99_AFTER_400[1])
    {
        let own = found.values[place(&tracker, name)];
        assert!((own - value).abs() < 1e-6 * error, "{name}: {own}, {value}");
    }
}

const RLS: [[f64; 6]; 2] = [
    [
        -0.847_834_896_039,
        0.985_708_853_133,
        -0.039_693_620_342,
        -3.394_662_171_279,
        -1.598_736_971_181,
        -4.792_211_356_779,
    ],
    [
        0.016_878_760_449,
        0.018_033_192_706,
        0.029_771_809_744,
        0.025_885_670_531,
        0.027_540_072_024,
        0.045_026_685_137,
    ],
];
const RLS_99: [[f64; 6]; 2] = [
    [
        -0.833_599_245_516,
        0.971_486_749_721,
        -0.050_570_548_182,
        -3.355_683_490_365,
        -1.596_530_269_858,
        -4.770_215_407_171,
    ],
    [
        0.029_462_404_171,
        0.025_263_765_744,
        0.035_288_002_459,
        0.043_033_750_52,
        0.037_240_127_806,
        0.051_911_212_91,
    ],
];
const RLS_99_AFTER_400: [[f64; 6]; 2] = [
    [
        -0.851_577_320_175,
        0.993_456_469_178,
        -0.026_581_518_34,
        -3.386_640_311_654,
        -1.601_866_098_546,
        -4.781_454_745_808,
    ],
    [
        0.014_751_898_773,
        0.015_678_826_439,
        0.026_861_254_179,
        0.023_870_250_532,
        0.023_621_283_281,
        0.038_873_678_507,
    ],
];
const RFT: [[f64; 6]; 2] = [
    [
        -0.850_484_052_403,
        0.981_290_809_861,
        -0.050_969_878_831,
        -3.393_759_443_836,
        -1.610_797_558_71,
        -4.814_559_361_068,
    ],
    [
        0.018_738_492_067,
        0.015_967_061_049,
        0.024_813_115_119,
        0.036_679_168_114,
        0.031_254_303_409,
        0.048_569_779_127,
    ],
];
const RFT_998: [[f64; 6]; 2] = [
    [
        -0.851_623_797_554,
        0.983_353_507_689,
        -0.047_443_507_895,
        -3.387_371_795_099,
        -1.613_122_165_386,
        -4.813_867_854_61,
    ],
    [
        0.024_063_313_437,
        0.019_427_462_333,
        0.030_970_933_154,
        0.047_630_824_451,
        0.038_454_639_687,
        0.061_303_738_74,
    ],
];
const EKF: [[f64; 6]; 2] = [
    [
        -0.851_251_897_267,
        0.982_366_888_745,
        -0.064_769_821_999,
        -3.382_378_336_987,
        -1.571_949_260_823,
        -4.784_554_889_397,
    ],
    [
        0.007_418_970_372,
        0.006_505_440_951,
        0.010_309_332_397,
        0.014_658_104_13,
        0.012_112_246_309,
        0.017_077_075_043,
    ],
];
const EKF_998: [[f64; 6]; 2] = [
    [
        -0.847_593_889_916,
        0.989_255_751_729,
        -0.046_236_048_927,
        -2.598_978_200_275,
        -1.623_840_522_712,
        -4.862_809_819_808,
    ],
    [
        0.010_950_400_574,
        0.010_533_505_568,
        0.016_995_704_565,
        0.287_049_657_756,
        0.023_177_121_145,
        0.040_166_544_962,
    ],
];

fn batch(plan: &Plan) -> Estimate {
    let result = trimtab_core::job::run(plan, &mut |_| ControlFlow::Continue(()));
    result.unwrap_or_else(|faults| panic!("{faults}")).estimate
}

/// How far, in standard errors of the batch, recursive estimates are from it at the end of the record.
fn distance(batch: &Estimate, tracker: &Tracker, found: &Estimates) -> f64 {
    let mut far = 0.0_f64;
    for (i, parameter) in tracker.parameters().iter().enumerate() {
        let mut rows = batch.parameters.iter();
        let row = rows.find(|row| row.name == parameter.name).expect("a row");
        // what the batch does not determine the tracker does not, either
        let Some(error) = row.standard_error else {
            assert!(
                found.values[i].is_nan(),
                "{}: {}",
                parameter.name,
                found.values[i]
            );
            continue;
        };
        far = far.max((found.values[i] - row.estimate).abs() / error);
    }
    far
}

/// Half widths from which the batch chooses what suits the whole record best, which nobody knows in flight.
const HALF_WIDTHS: [usize; 9] = [2, 3, 4, 6, 8, 12, 16, 24, 32];

#[test]
fn recursive_least_squares_end_where_the_batch_does() {
    let mut worst = 0.0_f64;
    for seed in 1..=100 {
        let estimator = json!({"options": {"estimator": "equation_error", "tolerance": 1e-10}});
        let plan = elevator(
            flown(include_str!("../../data/elevator.toml"), seed),
            estimator,
        );
        let batch = batch(&plan);
        let distances = HALF_WIDTHS.map(|half_width| {
            let (tracker, found) =
                tracked(&plan, json!({"method": "rls", "half_width": half_width}));
            assert_eq!(tracker.parameters().len(), 6);
            distance(&batch, &tracker, &found)
        });
        // with the window that the batch has chosen
        worst = worst.max(distances.into_iter().fold(f64::INFINITY, f64::min));
    }
    println!("farthest from the batch: {worst:e} standard errors");
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn recursive_fourier_regression_ends_where_the_batch_does() {
    let frequency = json!({"band_hz": [0.1, 1.5], "step_hz": 0.04});
    let options = json!({"estimator": "equation_error_frequency", "frequency": frequency, "tolerance": 1e-10});
    let asked = json!({"method": "rft", "frequency": frequency});
    let mut worst = 0.0_f64;
    for seed in 1..=100 {
        let maneuver = flown(include_str!("../../data/elevator.toml"), seed);
        let plan = elevator(maneuver, json!({"options": options}));
        let (tracker, found) = tracked(&plan, asked.clone());
        worst = worst.max(distance(&batch(&plan), &tracker, &found));
    }
    println!("farthest from the batch: {worst:e} standard errors");
    assert!(worst < 0.1, "{worst}");
}

/// A lateral acceleration has derivatives that an equation of motion has, too: equations are weighed against each other.
#[test]
fn equations_that_share_parameters_are_weighed_as_the_batch_does() {
    let scenario = include_str!("../../data/aileron.toml");
    let frequency = json!({"band_hz": [0.1, 1.2], "step_hz": 0.05});
    let changes = |estimator: &str, frequency: Option<&Value>| {
        let mut options = json!({"estimator": estimator, "tolerance": 1e-10});
        if let Some(frequency) = frequency {
            options["frequency"] = frequency.clone();
        }
        json!({"options": options})
    };
    let maneuver = flown(scenario, 7);
    let model = json!("lateral-directional-4");
    let of_time = plan(
        model.clone(),
        changes("equation_error", None),
        std::slice::from_ref(&maneuver),
    );
    let (in_time, best) = (
        batch(&of_time),
        HALF_WIDTHS.map(|half_width| {
            let (tracker, found) =
                tracked(&of_time, json!({"method": "rls", "half_width": half_width}));
            distance(&batch(&of_time), &tracker, &found)
        }),
    );
    let far = best.into_iter().fold(f64::INFINITY, f64::min);
    println!("rls: {far:e}, {} parameters", in_time.parameters.len());
    assert!(far < 0.1, "{far}");
    let of_band = plan(
        model,
        changes("equation_error_frequency", Some(&frequency)),
        &[maneuver],
    );
    let (tracker, found) = tracked(&of_band, json!({"method": "rft", "frequency": frequency}));
    let far = distance(&batch(&of_band), &tracker, &found);
    println!("rft: {far:e}");
    assert!(far < 0.1, "{far}");
}

/// By derivative, over seeds: errors and bounds of the filter, and errors of output error.
struct Errors(Vec<Vec<[f64; 3]>>);

impl Errors {
    /// Of filters that start off the truth by normal errors of the size that they are told: by a share of each derivative, and
    /// by a tenth of a degree in trim and bias. Every seed has other noise and other starts.
    fn of(seeds: std::ops::Range<u64>, share: f64) -> Self {
        let scenario: Scenario =
            toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario");
        let truth = &scenario.truth;
        let all = NAMES.iter().map(|name| (*name, share * truth[*name].abs()));
        let sizes: Vec<(&str, f64)> = all
            .chain([("alpha_eq", 2e-3), ("de_eq", 2e-3), ("q_bias", 3e-3)])
            .collect();
        let mut rows = vec![Vec::new(); NAMES.len()];
        for seed in seeds {
            let mut starts = json!({"alpha_0": {"start": truth["alpha_0"]}});
            for (place, (name, size)) in (0..).zip(&sizes) {
                let start = truth[*name] + size * normal(1_000_000 * seed + place);
                starts[*name] = json!({"start": start});
            }
            let maneuver = flown(include_str!("../../data/elevator.toml"), seed);
            let plan = elevator(maneuver, json!({"parameters": starts}));
            let uncertainty: serde_json::Map<String, Value> = sizes
                .iter()
                .map(|(name, size)| (name.to_string(), json!(size)))
                .collect();
            let (tracker, found) =
                tracked(&plan, with(filter(), json!({"uncertainty": uncertainty})));
            let batch = batch(&plan);
            for (row, name) in rows.iter_mut().zip(NAMES) {
                let at = place(&tracker, name);
                let own = batch.parameters.iter().find(|row| row.name == name);
                let own = own.expect("a row").estimate;
                row.push([
                    found.values[at] - truth[name],
                    found.standard_errors[at],
                    own - truth[name],
                ]);
            }
        }
        Self(rows)
    }

    fn mean(row: &[[f64; 3]], of: impl Fn(&[f64; 3]) -> f64) -> f64 {
        row.iter().map(of).sum::<f64>() / row.len() as f64
    }

    fn scatter(row: &[[f64; 3]], which: usize) -> f64 {
        let (count, middle) = (row.len() as f64, Self::mean(row, |all| all[which]));
        (Self::mean(row, |all| (all[which] - middle).powi(2)) * count / (count - 1.0)).sqrt()
    }

    /// In standard errors of the mean, by derivative.
    fn biases(&self) -> Vec<f64> {
        let bias = |row: &Vec<[f64; 3]>| {
            Self::mean(row, |all| all[0]) / (Self::scatter(row, 0) / (row.len() as f64).sqrt())
        };
        self.0.iter().map(bias).collect()
    }

    /// The share of errors within two bounds, of all derivatives.
    fn inside(&self) -> f64 {
        let inside =
            |row: &Vec<[f64; 3]>| Self::mean(row, |all| f64::from(all[0].abs() <= 2.0 * all[1]));
        self.0.iter().map(inside).sum::<f64>() / self.0.len() as f64
    }

    fn print(&self, title: &str) {
        println!(
            "{title}: {:.4} inside two bounds; bias in standard errors of the mean, scatter, mean bound, scatter of output error",
            self.inside()
        );
        for ((row, name), bias) in self.0.iter().zip(NAMES).zip(self.biases()) {
            let bound = Self::mean(row, |all| all[1]);
            println!(
                "  {name:4} {bias:6.2} {:.3e} {bound:.3e} {:.3e}",
                Self::scatter(row, 0),
                Self::scatter(row, 2)
            );
        }
    }
}

/// Where starts are off by a tenth the filter is as good as linear, and its bounds are those of theory; where they are off by the
/// whole, it is not, and its bounds are too small, as the guide says.
#[test]
fn the_bounds_of_the_filter_hold_where_it_starts_near_and_not_where_it_starts_far_off() {
    let near = Errors::of(1..201, 0.1);
    near.print("starts off by a tenth");
    assert!((0.93..=0.97).contains(&near.inside()), "{}", near.inside());
    for (bias, name) in near.biases().iter().zip(NAMES) {
        assert!(bias.abs() < 3.0, "{name}: {bias}");
    }
    // it knows where it started, and output error does not
    for (row, name) in near.0.iter().zip(NAMES) {
        let both = [0, 2].map(|which| Errors::scatter(row, which));
        assert!(both[0] < 1.1 * both[1], "{name}: {both:?}");
    }
    let others = Errors::of(20_001..20_201, 0.1);
    others.print("the same, other seeds");
    assert!(
        (0.93..=0.97).contains(&others.inside()),
        "{}",
        others.inside()
    );
    let far = Errors::of(1..201, 0.5);
    far.print("starts off by a half");
    let all = Errors::of(1..201, 1.0);
    all.print("starts off by the whole");
    assert!(
        all.inside() < 0.9,
        "{}: the guide says that the bounds are too small",
        all.inside()
    );
}

/// Ma changes from -3.4 to -2.4 1/s² while the elevator goes on with a sum of sines.
fn changing(seed: u64) -> (ModelDocument, Arc<Maneuver>) {
    let document = r#"
        name = "changing"
        [inputs.de]
        unit = "rad"
        [parameters]
        Za = { unit = "1/s", start = -0.8 }
        Zde = { unit = "1/s", start = -0.1 }
        Ma = { unit = "1/s^2", start = -3.0 }
        Mq = { unit = "1/s", start = -1.5 }
        Mde = { unit = "1/s^2", start = -5.0 }
        [states.alpha]
        unit = "rad"
        initial = "0"
        derivative = "Za*alpha + q + Zde*de"
        [states.q]
        unit = "rad/s"
        initial = "0"
        derivative = "Ma*alpha + Mq*q + Mde*de"
        [outputs.alpha]
        unit = "rad"
        equation = "alpha"
        [outputs.q]
        unit = "rad/s"
        equation = "q"
    "#;
    let (step, count) = (0.02, 4001);
    let de = |t: f64| {
        0.01 * [0.3, 0.5, 0.8, 1.1]
            .iter()
            .enumerate()
            .map(|(i, f)| (std::f64::consts::TAU * f * t + i as f64).sin())
            .sum::<f64>()
    };
    let slope = |t: f64, [alpha, q]: [f64; 2]| {
        let ma = if t < 40.0 { -3.4 } else { -2.4 };
        [
            -0.85 * alpha + q - 0.08 * de(t),
            ma * alpha - 1.6 * q - 4.8 * de(t),
        ]
    };
    let mut x = [0.0, 0.0];
    let (mut time, mut channels) = (Vec::new(), [const { Vec::new() }; 3]);
    for k in 0..count {
        let t = f64::from(k) * step;
        let noise = |n: u64| normal(seed * 100_000 + 2 * u64::try_from(k).expect("a count") + n);
        time.push(t);
        for (channel, value) in
            channels
                .iter_mut()
                .zip([de(t), x[0] + 2e-4 * noise(0), x[1] + 4e-4 * noise(1)])
        {
            channel.push(value);
        }
        let along = |x: [f64; 2], h: f64, k: [f64; 2]| [x[0] + h * k[0], x[1] + h * k[1]];
        let k1 = slope(t, x);
        let k2 = slope(t + step / 2.0, along(x, step / 2.0, k1));
        let k3 = slope(t + step / 2.0, along(x, step / 2.0, k2));
        let k4 = slope(t + step, along(x, step, k3));
        for i in 0..2 {
            x[i] += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    let names = [("de", "rad"), ("alpha", "rad"), ("q", "rad/s")];
    let channels = names.iter().zip(channels).map(|((name, unit), values)| {
        let unit_of = trimtab_core::flight::Unit::parse(unit).expect("a unit");
        let channel = trimtab_core::flight::Channel::from_recorded(unit, unit_of, values);
        (name.to_string(), channel)
    });
    let maneuver = Maneuver::new(time, channels.collect()).expect("a maneuver");
    (
        toml::from_str(document).expect("a document"),
        Arc::new(maneuver),
    )
}

/// A normal number of a place (Box and Muller, of a hash).
fn normal(place: u64) -> f64 {
    let uniform = |salt: u64| {
        let mut z = (place ^ salt).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (a, b) = (uniform(0x51ED).max(1e-300), uniform(0xC0FFEE_u64 << 24));
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// 80 s, the change at 40 s. At 70 s what forgets knows the new value, and what forgets nothing does not.
#[test]
fn a_parameter_that_changes_in_flight_is_followed_with_forgetting() {
    let noise = json!({"alpha": 2e-4, "q": 4e-4});
    let band = json!({"band_hz": [0.1, 1.5]});
    let cases = [
        (json!({"method": "rls"}), json!({"forgetting": 0.996})),
        (
            json!({"method": "rft", "frequency": band}),
            json!({"forgetting": 0.996}),
        ),
        (
            json!({"method": "ekf", "noise": noise}),
            json!({"drift": {"Ma": 0.1}}),
        ),
    ];
    let (document, maneuver) = changing(3);
    let document = serde_json::to_value(document).expect("JSON");
    let plan = plan(document, json!({}), &[maneuver]);
    let segment = &plan.problem.segments[0];
    for (asked, forgetting) in cases {
        for (asked, follows) in [(with(asked.clone(), forgetting), true), (asked, false)] {
            let mut tracker = tracker(&plan, asked.clone());
            let (ma, mq) = (place(&tracker, "Ma"), place(&tracker, "Mq"));
            let mut at = Vec::new();
            for k in 0..segment.len() {
                let found = push(&mut tracker, segment, k).expect("a sample");
                if [39.5, 70.0]
                    .iter()
                    .any(|t| (segment.time[k] - t).abs() < 1e-6)
                {
                    at.push([
                        found.values[ma],
                        found.standard_errors[ma],
                        found.values[mq],
                    ]);
                }
            }
            println!("{asked}: {at:?}");
            let off = |at: [f64; 3], truth: f64| (at[0] - truth).abs();
            assert!(
                off(at[0], -3.4) < 0.1,
                "{asked}: before the change {:?}",
                at[0]
            );
            assert_eq!(
                off(at[1], -2.4) < 0.1,
                follows,
                "{asked}: after it {:?}",
                at[1]
            );
            if follows {
                assert!(off(at[1], -2.4) < 4.0 * at[1][1], "{asked}: {:?}", at[1]);
            }
        }
    }
}

/// A sample that is refused changes nothing; what is not measured is left out.
#[test]
fn samples_that_cannot_be_taken_are_refused_and_change_nothing() {
    let plan = elevator(recorded(), known_starts());
    let segment = &plan.problem.segments[0];
    let band = json!({"method": "rft", "frequency": {"band_hz": [0.1, 1.5]}});
    for asked in [json!({"method": "rls"}), band.clone(), filter()] {
        let (mut clean, mut disturbed) =
            (tracker(&plan, asked.clone()), tracker(&plan, asked.clone()));
        for k in 0..300 {
            push(&mut clean, segment, k).expect("a sample");
            if k % 7 == 3 {
                let sample = |time: f64, inputs: &[f64], outputs: &[f64]| {
                    let sample = Sample {
                        time,
                        inputs,
                        outputs,
                    };
                    disturbed.push(&sample).map(|_| ()).expect_err("a fault")
                };
                let mut refuse = sample;
                let time = segment.time[k];
                assert_eq!(refuse(f64::NAN, &[0.0], &[0.0; 2]), SampleFault::NoTime);
                let before = segment.time[k - 1];
                assert_eq!(
                    refuse(before, &[0.0], &[0.0; 2]),
                    SampleFault::NotLater {
                        time: before,
                        before
                    }
                );
                assert!(
                    matches!(refuse(time, &[f64::NAN], &[0.0; 2]), SampleFault::NoInput { name } if name == "de")
                );
                assert!(matches!(
                    refuse(time, &[0.0; 2], &[0.0; 2]),
                    SampleFault::Width {
                        what: "inputs",
                        found: 2,
                        wanted: 1
                    }
                ));
                if asked["method"] == "rft" {
                    assert!(matches!(
                        refuse(time + 0.04, &[0.0], &[0.0; 2]),
                        SampleFault::Uneven { .. }
                    ));
                }
            }
            push(&mut disturbed, segment, k).expect("a sample");
        }
        // before the maneuver nothing is known of some
        let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
        assert!(
            same(&clean.estimates().values, &disturbed.estimates().values),
            "{asked}"
        );
        assert!(
            clean
                .estimates()
                .values
                .iter()
                .all(|value| value.is_finite()),
            "{asked}: {:?}",
            clean.estimates()
        );
        let none = [f64::NAN; 2];
        let sample = Sample {
            time: segment.time[300],
            inputs: &[segment.inputs[0][300]],
            outputs: &none,
        };
        let after = clean
            .push(&sample)
            .expect("a sample without outputs")
            .clone();
        assert!(
            after.values.iter().all(|value| value.is_finite()),
            "{asked}: {after:?}"
        );
    }
    // the elevator does not move in the first 6 s
    let mut still = tracker(&plan, json!({"method": "rls"}));
    for k in 0..100 {
        push(&mut still, segment, k).expect("a sample");
    }
    let unknown = still.estimates().clone();
    for (i, parameter) in still.parameters().iter().enumerate() {
        let of_elevator = ["Zde", "Mde"].contains(&parameter.name.as_str());
        assert_eq!(unknown.values[i].is_nan(), of_elevator, "{unknown:?}");
        assert_eq!(
            unknown.standard_errors[i].is_nan(),
            of_elevator,
            "{unknown:?}"
        );
    }
}

#[test]
fn what_a_method_cannot_follow_is_refused_with_the_remedy() {
    let plan = elevator(recorded(), json!({}));
    let setup = Setup::of_problem(&plan.problem).expect("a segment");
    let refused = |setup: &Setup, asked: Value| -> Vec<(String, String)> {
        let faults: Vec<trimtab_core::flight::Fault> = Tracker::new(setup, &options(asked.clone()))
            .err()
            .unwrap_or_else(|| panic!("{asked} is taken"))
            .into();
        faults
            .into_iter()
            .map(|fault| (fault.pointer, fault.message))
            .collect()
    };
    let cases = [
        (
            json!({"method": "rls", "forgetting": 0.0}),
            "/forgetting",
            "above 0",
        ),
        (
            json!({"method": "rls", "forgetting": 1.01}),
            "/forgetting",
            "at most 1",
        ),
        (
            json!({"method": "rls", "half_width": 1}),
            "/half_width",
            "2 to 64",
        ),
        (
            json!({"method": "rls", "frequency": {"band_hz": [0.1, 1.0]}}),
            "/frequency",
            "use rft",
        ),
        (
            json!({"method": "rls", "noise": {"q": 1.0}}),
            "/noise",
            "use ekf",
        ),
        (json!({"method": "rft"}), "/frequency", "band_hz"),
        (
            json!({"method": "rft", "frequency": {"band_hz": [1.0, 0.1]}}),
            "/frequency/band_hz",
            "above that",
        ),
        (
            json!({"method": "rft", "frequency": {"band_hz": [0.1, 9.0], "step_hz": 1e-3}}),
            "/frequency",
            "500",
        ),
        (
            json!({"method": "ekf"}),
            "/noise/alpha",
            "standard deviation",
        ),
        (
            json!({"method": "ekf", "noise": {"alpha": -1.0, "q": 1.0}}),
            "/noise/alpha",
            "above 0",
        ),
        (
            json!({"method": "ekf", "noise": {"alpha": 1.0, "q": 1.0}}),
            "/uncertainty/q_bias",
            "starts from 0",
        ),
        (
            json!({"method": "ekf", "noise": {"alpha": 1.0, "q": 1.0, "x": 1.0}}),
            "/noise/x",
            "alpha, q",
        ),
    ];
    for (asked, pointer, word) in cases {
        let faults = refused(&setup, asked.clone());
        let found = faults.iter().find(|(at, _)| at == pointer);
        let (_, message) = found.unwrap_or_else(|| panic!("{asked}: {faults:?}"));
        assert!(message.contains(word), "{asked}: {message}");
    }
    let model = |change: &dyn Fn(&mut Value)| {
        let (document, _) = changing(1);
        let mut document = serde_json::to_value(document).expect("JSON");
        change(&mut document);
        let document: ModelDocument = serde_json::from_value(document).expect("a document");
        Setup::of_model(Model::compile(&document).expect("a model"))
    };
    let rls = json!({"method": "rls"});
    let product = model(&|document| {
        document["states"]["q"]["derivative"] = json!("Ma*alpha + Mq*Ma/Mde*q + Mde*de")
    });
    assert!(
        refused(&product, rls.clone())[0]
            .1
            .contains("not linear in Ma, Mq, Mde together"),
        "{:?}",
        refused(&product, rls.clone())
    );
    let unseen = model(&|document| document["outputs"]["q"]["equation"] = json!("q + Mq*alpha"));
    assert!(
        refused(&unseen, rls.clone())[0]
            .1
            .contains("no output measures q")
    );
    let late = model(&|document| {
        document["parameters"]["tau"] = json!({"unit": "s", "start": 0.1, "fixed": true});
        document["inputs"]["de"]["delay"] = json!("tau");
    });
    assert!(
        refused(&late, rls.clone())[0].1.contains("de has a delay"),
        "{:?}",
        refused(&late, rls.clone())
    );
    let held = model(&|document| {
        for (_, parameter) in document["parameters"].as_object_mut().expect("parameters") {
            parameter["fixed"] = json!(true);
        }
    });
    assert!(refused(&held, rls)[0].1.contains("no parameter is free"));
    assert_eq!(
        TrackingMethod::ALL.map(TrackingMethod::name),
        ["rls", "rft", "ekf"]
    );
}
