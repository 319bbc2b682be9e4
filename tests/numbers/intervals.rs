//! Confidence intervals by refits, against closed forms of models so simple that they have one.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::estimate::{
    ConfidenceInterval, ConfidenceIntervals, IntervalEnd, IntervalMethod, Outcome, Progress,
};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobResult};
use trimtab_core::simulate::{NoiseColour, Scenario};

use crate::common::estimation::compiled;
use crate::common::plans::{plan, recording, solve, try_plan};

const SAMPLES: usize = 240;

/// χ² with one degree of freedom, 95 % (scipy.stats.chi2.ppf(0.95, 1)).
const CHI_SQUARED: f64 = 3.841_458_820_694_124;

/// Numbers as random as a test needs, from -1 to 1: those of a linear congruential generator.
fn scatter(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed;
    let next = |_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
    };
    (0..count).map(next).collect()
}

/// y = `equation` of x, recorded with values `y` at x = 0, 1/N, ...
fn fitted(equation: &str, parameters: Value, y: Vec<f64>, options: Value) -> JobResult {
    let (maneuver, model) = stated(equation, parameters, y);
    solve(model, json!({ "options": options }), &[maneuver])
}

fn stated(equation: &str, parameters: Value, y: Vec<f64>) -> (Arc<Maneuver>, Value) {
    let time: Vec<f64> = (0..y.len()).map(|k| 0.1 * k as f64).collect();
    let x: Vec<f64> = (0..y.len()).map(|k| k as f64 / y.len() as f64).collect();
    let model = json!({
        "name": "static", "inputs": {"x": {"unit": "-"}}, "states": {}, "parameters": parameters,
        "outputs": {"y": {"unit": "-", "equation": equation}},
    });
    (recording(time, &[("x", x), ("y", y)]), model)
}

fn found(result: &JobResult) -> &ConfidenceIntervals {
    result
        .estimate
        .confidence_intervals
        .as_ref()
        .expect("intervals")
}

fn interval(result: &JobResult, name: &str, method: IntervalMethod) -> ConfidenceInterval {
    let mut all = found(result).parameters.iter();
    let parameter = all.find(|p| p.name == name).expect("the parameter");
    let mut all = parameter.intervals.iter();
    *all.find(|i| i.method == method)
        .unwrap_or_else(|| panic!("{name}: no {method:?}"))
}

fn ends(interval: &ConfidenceInterval) -> [f64; 2] {
    [
        interval.lower.expect("a lower end"),
        interval.upper.expect("an upper end"),
    ]
}

fn near(found: f64, expected: f64, share: f64) {
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{found} is not {expected}"
    );
}

/// A straight line with noise of unknown variance: SSE(v) = SSE + (v − â)² Σ(x − x̄)² and 2 Δln L = N ln(SSE(v)/SSE).
#[test]
fn the_profile_of_a_straight_line_is_what_its_closed_form_says() {
    let e = scatter(1, SAMPLES);
    let x = |k: usize| k as f64 / SAMPLES as f64;
    let y: Vec<f64> = (0..SAMPLES)
        .map(|k| 2.0 * x(k) + 0.5 + 0.3 * e[k])
        .collect();
    let options = json!({"confidence_intervals": {"bootstrap": 0, "monte_carlo": 0}});
    let free = json!({"a": {"unit": "-", "start": 1.0}, "b": {"unit": "-", "start": 0.0}});
    let result = fitted("a*x + b", free, y.clone(), options.clone());

    let n = SAMPLES as f64;
    let (mean_x, mean_y) = (
        (0..SAMPLES).map(x).sum::<f64>() / n,
        y.iter().sum::<f64>() / n,
    );
    let spread: f64 = (0..SAMPLES).map(|k| (x(k) - mean_x).powi(2)).sum();
    let product: f64 = (0..SAMPLES)
        .map(|k| (x(k) - mean_x) * (y[k] - mean_y))
        .sum();
    let slope = product / spread;
    let left = |k: usize| y[k] - mean_y - slope * (x(k) - mean_x);
    let squares: f64 = (0..SAMPLES).map(|k| left(k).powi(2)).sum();
    let half = (squares * ((CHI_SQUARED / n).exp() - 1.0) / spread).sqrt();

    let profile = interval(&result, "a", IntervalMethod::Profile);
    let [lower, upper] = ends(&profile);
    near(slope - lower, half, 0.003);
    near(upper - slope, half, 0.003);
    near(profile.asymmetry.expect("both ends"), 1.0, 0.005);
    // white residuals: the correction of a white noise is next to none
    let corrected = interval(&result, "a", IntervalMethod::Corrected);
    let conventional = interval(&result, "a", IntervalMethod::Conventional);
    let ratio =
        corrected.standard_deviation.expect("it") / conventional.standard_deviation.expect("it");
    let [_, wider] = ends(&interval(&result, "a", IntervalMethod::ProfileCorrected));
    let half = (squares * ((ratio * ratio * CHI_SQUARED / n).exp() - 1.0) / spread).sqrt();
    near(wider - slope, half, 0.003);

    // a bound that is nearer than the end is where the interval ends
    let bound = slope + 0.4 * (upper - slope);
    let free =
        json!({"a": {"unit": "-", "start": 1.0, "upper": bound}, "b": {"unit": "-", "start": 0.0}});
    let result = fitted("a*x + b", free, y, options);
    let profile = interval(&result, "a", IntervalMethod::Profile);
    assert_eq!(
        (profile.lower_end, profile.upper_end),
        (IntervalEnd::Found, IntervalEnd::Bound)
    );
    near(profile.upper.expect("the bound"), bound, 1e-12);
    near(
        slope - profile.lower.expect("a lower end"),
        slope - lower,
        0.003,
    );
    assert_eq!(profile.asymmetry, None);
}

/// y = exp(a x) with a variance that is given: (SSE(v) − SSE)/σ² = 3.84 on either side, found by halving; not symmetric.
#[test]
fn a_profile_that_is_not_symmetric() {
    const VARIANCE: f64 = 4.0;
    let e = scatter(2, 20);
    let x = |k: usize| k as f64 / 20.0;
    let y: Vec<f64> = (0..20).map(|k| (1.5 * x(k)).exp() + 3.0 * e[k]).collect();
    let options = json!({
        "noise": {"kind": "given", "variance": [VARIANCE]}, "error_bounds": "conventional", "tolerance": 1e-9,
        "confidence_intervals": {"bootstrap": 0, "monte_carlo": 0},
    });
    let free = json!({"a": {"unit": "-", "start": 1.0}});
    let result = fitted("exp(a*x)", free, y.clone(), options);
    let squares = |a: f64| -> f64 {
        (0..20)
            .map(|k| (y[k] - (a * x(k)).exp()).powi(2))
            .sum::<f64>()
            / VARIANCE
    };
    let estimate = result.estimate.parameters[0].estimate;
    let end = |direction: f64| {
        let (mut near, mut far) = (0.0, 20.0);
        for _ in 0..200 {
            let middle = 0.5 * (near + far);
            match squares(estimate + direction * middle) - squares(estimate) < CHI_SQUARED {
                true => near = middle,
                false => far = middle,
            }
        }
        near
    };
    let profile = interval(&result, "a", IntervalMethod::Profile);
    let [lower, upper] = ends(&profile);
    near(estimate - lower, end(-1.0), 0.003);
    near(upper - estimate, end(1.0), 0.003);
    let asymmetry = profile.asymmetry.expect("both ends");
    assert!(asymmetry < 0.8, "{asymmetry}");
    // one that the information matrix alone does not show
    let bound = interval(&result, "a", IntervalMethod::Conventional);
    near(bound.asymmetry.expect("both ends"), 1.0, 1e-6);
    let corrected = |i: &ConfidenceInterval| i.method == IntervalMethod::ProfileCorrected;
    assert!(!found(&result).parameters[0].intervals.iter().any(corrected));
}

/// A mean of residuals in blocks of b: its variance is that of the N − b + 1 block means over the number of blocks, and
/// the fit of one constant has taken the share 1/N off white noise (more off coloured noise).
#[test]
fn the_bootstrap_of_a_mean_has_the_variance_of_its_blocks() {
    const BLOCK: usize = 12;
    let mut e = scatter(3, SAMPLES);
    for k in 1..SAMPLES {
        e[k] += 0.8 * e[k - 1];
    }
    let y: Vec<f64> = e.iter().map(|e| 3.0 + e).collect();
    let options = json!({"confidence_intervals": {"bootstrap": 4000, "block": BLOCK, "profile": false, "monte_carlo": 0}});
    let free = json!({"b": {"unit": "-", "start": 0.0}});
    let result = fitted("b", free, y.clone(), options);

    let mean = y.iter().sum::<f64>() / SAMPLES as f64;
    let blocks = y.windows(BLOCK);
    let means: Vec<f64> = blocks
        .map(|b| b.iter().sum::<f64>() / BLOCK as f64 - mean)
        .collect();
    let centre = means.iter().sum::<f64>() / means.len() as f64;
    let variance = means.iter().map(|m| (m - centre).powi(2)).sum::<f64>() / means.len() as f64;
    let of_blocks = (variance / (SAMPLES / BLOCK) as f64).sqrt();
    // residuals are made as large as the noise was: N (corrected standard error)² of N σ² is what the mean took off
    let error = result.estimate.parameters[0].standard_error.expect("it");
    let squares: f64 = y.iter().map(|y| (y - mean).powi(2)).sum();
    let factor = (1.0 + SAMPLES as f64 * error * error / squares).sqrt();
    let bootstrap = interval(&result, "b", IntervalMethod::Bootstrap);
    // three standard deviations of one of 4000: 3/√8000
    near(
        bootstrap.standard_deviation.expect("it"),
        factor * of_blocks,
        0.034,
    );
    let [lower, upper] = ends(&bootstrap);
    near(upper - lower, 2.0 * 1.96 * factor * of_blocks, 0.08);
    let made = found(&result).bootstrap.expect("it");
    assert_eq!((made.replicates, made.failed, made.block), (4000, 0, BLOCK));
}

/// Of white noise the Monte Carlo of a mean has s/√N; with its colour, that of the corrected bound, which is from the same model.
#[test]
fn monte_carlo_has_the_noise_of_the_error_bounds() {
    let mut e = scatter(4, SAMPLES);
    for k in 1..SAMPLES {
        e[k] += 0.8 * e[k - 1];
    }
    let y: Vec<f64> = e.iter().map(|e| 3.0 + e).collect();
    let mean = y.iter().sum::<f64>() / SAMPLES as f64;
    let squares: f64 = y.iter().map(|y| (y - mean).powi(2)).sum();
    let white = (squares / SAMPLES as f64 / SAMPLES as f64).sqrt();
    for kind in ["conventional", "corrected"] {
        let asked = json!({"bootstrap": 0, "profile": false, "monte_carlo": 4000});
        let options = json!({"error_bounds": kind, "confidence_intervals": asked});
        let free = json!({"b": {"unit": "-", "start": 0.0}});
        let result = fitted("b", free, y.clone(), options);
        let error = result.estimate.parameters[0].standard_error.expect("it");
        let deviation = interval(&result, "b", IntervalMethod::MonteCarlo).standard_deviation;
        near(deviation.expect("it"), error, 0.034);
        match kind {
            "conventional" => near(error, white, 1e-3),
            _ => assert!(error > 2.0 * white, "{error} {white}"),
        }
    }
}

/// The elevator maneuver with noise of a colour.
fn elevator(colour: NoiseColour) -> Arc<Maneuver> {
    let mut scenario: Scenario =
        toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario");
    for output in scenario.outputs.values_mut() {
        output.colour = colour;
    }
    Arc::new(scenario.fly(&compiled("short-period")).expect("a maneuver"))
}

/// One fit: the bootstrap's spread is that of the corrected bounds, and the profile's width that of the conventional ones.
#[test]
fn methods_agree_on_a_short_period_with_white_noise() {
    let options =
        json!({"confidence_intervals": {"bootstrap": 1000, "monte_carlo": 1000, "seed": 7}});
    let flown = elevator(NoiseColour::White);
    let result = solve(
        json!("short-period"),
        json!({ "options": options }),
        &[flown],
    );
    let intervals = found(&result);
    println!("{intervals:#?}");
    assert_eq!(intervals.parameters.len(), 9);
    for parameter in &intervals.parameters {
        let of = |method| interval(&result, &parameter.name, method);
        let width = |method| {
            let [lower, upper] = ends(&of(method));
            upper - lower
        };
        let corrected = width(IntervalMethod::Corrected);
        // 2.2 % is one standard deviation of 1000 replicates' own; percentiles scatter more
        near(width(IntervalMethod::Bootstrap), corrected, 0.15);
        near(width(IntervalMethod::MonteCarlo), corrected, 0.15);
        near(width(IntervalMethod::ProfileCorrected), corrected, 0.08);
        near(
            width(IntervalMethod::Profile),
            width(IntervalMethod::Conventional),
            0.08,
        );
    }
}

/// Whatever the number of threads, and another seed gives other numbers.
#[test]
fn a_seed_decides_the_numbers() {
    let flown = elevator(NoiseColour::FirstOrder {
        correlation_time: 0.2,
    });
    let found_by = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        let options =
            json!({"confidence_intervals": {"bootstrap": 100, "monte_carlo": 100, "seed": seed}});
        let changes = json!({ "options": options });
        let result =
            pool.install(|| solve(json!("short-period"), changes, std::slice::from_ref(&flown)));
        found(&result).clone()
    };
    let one = found_by(1, 1);
    assert_eq!(one, found_by(3, 1));
    let other = found_by(2, 2);
    assert_ne!(one.parameters[3].intervals, other.parameters[3].intervals);
    assert!(one.bootstrap.expect("it").block > 3, "{:?}", one.bootstrap);
    assert!(
        one.remarks.iter().any(|remark| remark.contains("coloured")),
        "{:?}",
        one.remarks
    );
}

/// Two recordings, in one of them only every fifth sample of alpha: what was not measured is not made up, and each is drawn
/// from by itself.
#[test]
fn several_recordings_and_missing_samples() {
    let flown = elevator(NoiseColour::White);
    let sparse = {
        let mut channels = flown.channels().clone();
        let alpha = &mut channels["alpha"].values;
        for row in 0..alpha.len() {
            alpha[row] = alpha[row / 5 * 5];
        }
        Arc::new(Maneuver::new(flown.time().to_vec(), channels).expect("a maneuver"))
    };
    let options =
        json!({"confidence_intervals": {"bootstrap": 400, "parameters": ["Ma"], "monte_carlo": 0}});
    let changes = json!({
        "options": options,
        "maneuvers": [
            {"id": flown.digest(), "label": "first"},
            {"id": sparse.digest(), "label": "second", "channels": {"alpha": "fresh(alpha)"}},
        ],
    });
    let result = solve(json!("short-period"), changes, &[flown, sparse]);
    let all = found(&result);
    let made = all.bootstrap.expect("it");
    assert_eq!(made.failed, 0);
    for parameter in &all.parameters {
        let of = |method| {
            let interval = interval(&result, &parameter.name, method);
            interval.standard_deviation.expect("it")
        };
        // 3.5 % is one standard deviation of 400 replicates' own
        near(
            of(IntervalMethod::Bootstrap),
            of(IntervalMethod::Corrected),
            0.15,
        );
    }
    let profiled = all.parameters.iter().filter(|parameter| {
        let mut all = parameter.intervals.iter();
        all.any(|interval| interval.method == IntervalMethod::Profile)
    });
    let names: Vec<&str> = profiled.map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["Ma"]);
}

#[test]
fn who_stops_it_keeps_the_estimate() {
    let options = json!({"confidence_intervals": {"bootstrap": 1000}});
    let flown = elevator(NoiseColour::White);
    let plan = plan(
        json!("short-period"),
        json!({ "options": options }),
        &[flown],
    );
    let mut steps = 0;
    let result = job::run(&plan, &mut |told| match told {
        Progress::Step(step) => {
            steps += 1;
            println!("{} of {}: {}", step.number, step.of, step.finding);
            if steps == 2 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
        _ => ControlFlow::Continue(()),
    });
    let estimate = result
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
        .estimate;
    assert_eq!((estimate.outcome, steps), (Outcome::Cancelled, 2));
    assert!(estimate.confidence_intervals.is_none());
    assert!(
        estimate
            .reason
            .contains("stopped on request while confidence intervals"),
        "{}",
        estimate.reason
    );
    assert!(estimate.parameters[3].standard_error.is_some());
}

#[test]
fn an_estimate_that_is_none_has_no_intervals() {
    let options = json!({"max_iterations": 0, "confidence_intervals": {}});
    let flown = elevator(NoiseColour::White);
    let result = solve(
        json!("short-period"),
        json!({ "options": options }),
        &[flown],
    );
    let all = found(&result);
    assert!(
        all.parameters.is_empty() && all.remarks[0].contains("no minimum"),
        "{all:?}"
    );
}

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    let flown = elevator(NoiseColour::White);
    let refused = |changes: Value| -> Vec<String> {
        let faults = try_plan(json!("short-period"), changes, std::slice::from_ref(&flown));
        let faults = faults.err().expect("it is refused");
        faults.iter().map(|fault| fault.pointer.clone()).collect()
    };
    let place = "/options/confidence_intervals";
    let of = |intervals: Value| json!({"options": {"confidence_intervals": intervals}});
    for (intervals, field) in [
        (json!({"bootstrap": 10}), "bootstrap"),
        (json!({"monte_carlo": 20_000}), "monte_carlo"),
        (json!({"block": 0}), "block"),
        (json!({"bootstrap": 0, "block": 5}), "block"),
        (
            json!({"profile": false, "parameters": ["Ma"]}),
            "parameters",
        ),
        (
            json!({"profile": false, "bootstrap": 0, "monte_carlo": 0}),
            "profile",
        ),
        (json!({"parameters": ["Mx"]}), "parameters/Mx"),
    ] {
        assert_eq!(refused(of(intervals)), [format!("{place}/{field}")]);
    }
    for other in [
        json!({"kind": "diagnose"}),
        json!({"kind": "derivative_study"}),
    ] {
        let mut changes = of(json!({}));
        changes["kind"] = other["kind"].clone();
        assert_eq!(refused(changes), [place]);
    }
    let filter = json!({"options": {"estimator": "equation_error", "confidence_intervals": {}}});
    assert_eq!(refused(filter), [place]);
}
