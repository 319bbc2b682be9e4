//! The aircraft that are flown, and how.

use std::sync::LazyLock;

use indexmap::IndexMap;
use trimtab_core::diagnose::{Case, Effect, EffectKind, Flight, Treatment, candidates};
use trimtab_core::estimate::{Options, Role};
use trimtab_core::flight::Maneuver;
use trimtab_core::model::{EditKind, Model, ModelDocument, catalog};
use trimtab_core::simulate::{
    InputDesign, NoiseColour, Scenario, ScenarioEffect, ScenarioInput, Steps,
};

/// An aircraft with its flights: a declared model, and scenarios by role.
pub(crate) struct Aircraft {
    pub name: &'static str,
    pub model: Model,
    pub document: ModelDocument,
    flights: Vec<(Role, &'static str, Scenario)>,
}

const SHORT_PERIOD: [(Role, &str, &str); 2] = [
    (
        Role::Estimation,
        "3-2-1-1",
        r#"design = { shape = "3-2-1-1", start = 6.0, unit_time = 0.8, amplitude = 2.0 }"#,
    ),
    (
        Role::Validation,
        "doublet",
        r#"design = { shape = "doublet", start = 6.0, unit_time = 1.2, amplitude = -2.5 }"#,
    ),
];

fn short_period() -> Aircraft {
    let scenario = |design: &str| {
        let text = include_str!("../../../data/elevator.toml");
        let line = text
            .lines()
            .find(|line| line.starts_with("design"))
            .unwrap();
        toml::from_str(&text.replace(line, design)).unwrap()
    };
    let flights = SHORT_PERIOD
        .iter()
        .map(|(role, label, design)| (*role, *label, scenario(design)));
    Aircraft::new("short-period", flights.collect())
}

fn lateral() -> Aircraft {
    let of = |text: &str| -> Scenario { toml::from_str(text).unwrap() };
    let aileron = of(include_str!("../../../data/aileron.toml"));
    let rudder = of(include_str!("../../../data/rudder.toml"));
    // the other way round and a little later: a repeat that is none
    let turned = |scenario: &Scenario| {
        let text = toml::to_string(scenario).unwrap();
        let mut value: toml::Table = toml::from_str(&text).unwrap();
        for (_, input) in value["inputs"].as_table_mut().unwrap() {
            let design = input["design"].as_table_mut().unwrap();
            if let Some(amplitude) = design.get("amplitude").and_then(toml::Value::as_float) {
                design["amplitude"] = (-1.2 * amplitude).into();
            }
            for pulse in design
                .get_mut("pulses")
                .and_then(toml::Value::as_array_mut)
                .into_iter()
                .flatten()
            {
                let (length, amplitude) = (pulse[0].as_float(), pulse[1].as_float());
                if let (Some(length), Some(amplitude)) = (length, amplitude) {
                    *pulse = toml::Value::from(vec![1.3 * length, -1.2 * amplitude]);
                }
            }
        }
        value.try_into::<Scenario>().unwrap()
    };
    let (aileron_again, rudder_again) = (turned(&aileron), turned(&rudder));
    Aircraft::new(
        "lateral",
        vec![
            (Role::Estimation, "aileron", aileron),
            (Role::Estimation, "rudder", rudder),
            (Role::Validation, "aileron again", aileron_again),
            (Role::Validation, "rudder again", rudder_again),
        ],
    )
}

pub(crate) fn aircraft() -> Vec<Aircraft> {
    vec![short_period(), lateral()]
}

static WHITE: LazyLock<NoiseColour> = LazyLock::new(|| NoiseColour::White);

impl Aircraft {
    fn new(name: &'static str, flights: Vec<(Role, &'static str, Scenario)>) -> Self {
        let document = catalog::find(&flights[0].2.model).unwrap();
        let model = Model::compile(&document).unwrap();
        Self {
            name,
            model,
            document,
            flights,
        }
    }

    /// Effects of the catalogue that can be put into these flights.
    pub(crate) fn effects(&self) -> Vec<Effect> {
        let Some(case) = self.case(&[], None, 0) else {
            return Vec::new();
        };
        let outliers = |output| Effect::treatment(Treatment::SensorOutliers, output);
        let outputs = self.document.outputs.keys();
        candidates(&case, &self.model)
            .into_iter()
            .chain(outputs.map(outliers))
            .collect()
    }

    /// Variances of the white noise at the truth, SI, in the order of the outputs.
    pub(crate) fn variances(&self) -> Vec<f64> {
        let scenario = &self.flights[0].2;
        let of = |output: &trimtab_core::model::Quantity| {
            let recorded = &scenario.outputs[&output.name];
            let unit = trimtab_core::flight::Unit::parse(&recorded.unit).unwrap();
            (recorded.noise * unit.scale).powi(2)
        };
        self.model.outputs.iter().map(of).collect()
    }

    pub(crate) fn step(&self) -> f64 {
        self.flights[0].2.step
    }

    /// Flies it. Without a colour there is no noise.
    pub(crate) fn case(
        &self,
        effects: &[(&Effect, f64)],
        colour: Option<&NoiseColour>,
        seed: u64,
    ) -> Option<Case> {
        Some(self.flown(effects, colour, seed)?.case)
    }

    /// The same, with what was true of it.
    pub(crate) fn flown(
        &self,
        effects: &[(&Effect, f64)],
        colour: Option<&NoiseColour>,
        seed: u64,
    ) -> Option<Flown> {
        let mut flights = Vec::new();
        let mut truth = IndexMap::new();
        for (number, (role, label, scenario)) in self.flights.iter().enumerate() {
            let mut scenario = scenario.clone();
            scenario.seed = seed.wrapping_mul(101).wrapping_add(number as u64);
            for output in scenario.outputs.values_mut() {
                output.colour = *colour.unwrap_or(&WHITE);
                if colour.is_none() {
                    output.noise = 0.0;
                }
            }
            let is_local = |effect: &Effect| effect.kind == EffectKind::Edit(EditKind::Gust);
            for (effect, size) in effects {
                // a gust comes once
                if !is_local(effect) || number == 0 {
                    trim(&mut scenario, effect, *size);
                    slow_down(&mut scenario, effect);
                    scenario.effects.push(self.scenario_effect(effect, *size));
                }
            }
            if effects
                .iter()
                .any(|(effect, _)| effect.kind == EffectKind::Edit(EditKind::MissingTerm))
            {
                settle(&mut scenario, &self.model);
            }
            let maneuver = scenario.fly(&self.model).ok()?;
            flights.push(flight(&maneuver, *role, label, scenario.step));
            truth.insert(label.to_string(), scenario.truth);
        }
        let case = Case {
            document: self.document.clone(),
            flights,
            options: Options::default(),
            candidates: Vec::new(),
            knowledge: Default::default(),
            consumed: Vec::new(),
        };
        Some(Flown { case, truth })
    }

    fn scenario_effect(&self, effect: &Effect, size: f64) -> ScenarioEffect {
        let target = &effect.target;
        let of = |kind: &str, value: Option<f64>, values: IndexMap<String, f64>| ScenarioEffect {
            kind: kind.to_string(),
            target: target.clone(),
            term: None,
            parameter: None,
            unit: None,
            channels: IndexMap::new(),
            about: IndexMap::new(),
            value,
            values,
        };
        match effect.kind {
            EffectKind::Treatment(Treatment::SensorOutliers) => {
                let scenario = &self.flights[0].2;
                let samples = scenario.duration / scenario.step;
                let values = [
                    ("spikes", size / samples),
                    ("size", SPIKE * scenario.outputs[target].noise),
                ];
                let values = values.map(|(name, value)| (name.to_string(), value));
                return of("sensor_outliers", None, values.into_iter().collect());
            }
            EffectKind::Treatment(_) => return of("process_noise", Some(size), IndexMap::new()),
            EffectKind::Edit(_) => {}
        }
        let mut values = IndexMap::new();
        if effect.kind == EffectKind::Edit(EditKind::Gust) {
            values.insert(format!("{target}_gust_time"), 12.0);
            values.insert(format!("{target}_gust_length"), 1.5);
        }
        ScenarioEffect {
            value: Some(size),
            values,
            ..ScenarioEffect::from(&effect.edits[0])
        }
    }
}

/// Noise deviations that a spike is high; the size of outliers is how many there are in a recording.
const SPIKE: f64 = 10.0;

/// A case and what was true in it.
pub(crate) struct Flown {
    pub case: Case,
    /// Parameters, in their own units, by flight.
    pub truth: IndexMap<String, IndexMap<String, f64>>,
}

/// The flight is trimmed whatever the recorder says of the deflection.
fn trim(scenario: &mut Scenario, effect: &Effect, size: f64) {
    let Some(trimmed) = scenario.truth.get_mut(&format!("{}_eq", effect.target)) else {
        return;
    };
    match effect.kind {
        EffectKind::Edit(EditKind::InputScale) => *trimmed *= 1.0 + size,
        EffectKind::Edit(EditKind::InputBias) => *trimmed += size,
        _ => {}
    }
}

/// Derivatives that scale with dynamic pressure show where the speed changes.
fn slow_down(scenario: &mut Scenario, effect: &Effect) {
    if effect.term.as_deref() != Some("qbar") {
        return;
    }
    let Some(speed) = scenario.channels.shift_remove("V") else {
        return;
    };
    let design = InputDesign::Recorded {
        file: None,
        channel: None,
        time: vec![0.0, 5.0, scenario.duration],
        values: vec![speed.value, speed.value, 0.85 * speed.value],
    };
    let input = ScenarioInput {
        unit: speed.unit,
        trim: 0.0,
        design,
    };
    scenario.inputs.insert("V".to_string(), input);
}

/// How alpha and q move off in the first moment.
fn drift(scenario: &Scenario, model: &Model) -> Option<[f64; 2]> {
    let mut still = scenario.clone();
    (still.step, still.duration) = (1e-3, 2e-3);
    for input in still.inputs.values_mut() {
        input.design = InputDesign::Constant;
    }
    for output in still.outputs.values_mut() {
        output.noise = 0.0;
        output.colour = NoiseColour::White;
    }
    still.channels.clear();
    // what the recorder does to it is no matter of trim
    still
        .effects
        .retain(|effect| effect.kind == EditKind::MissingTerm.name());
    let maneuver = still.fly(model).ok()?;
    let rate = |name: &str| {
        let values = &maneuver.channels().get(name)?.values;
        Some((values[1] - values[0]) / still.step)
    };
    Some([rate("alpha")?, rate("q")?])
}

/// A flight begins in trim, with what the model lacks too: the equilibrium is shifted until nothing moves.
fn settle(scenario: &mut Scenario, model: &Model) {
    const NAMES: [&str; 2] = ["alpha_eq", "de_eq"];
    if !NAMES.iter().all(|name| scenario.truth.contains_key(*name)) {
        return;
    }
    for _ in 0..3 {
        let Some(now) = drift(scenario, model) else {
            return;
        };
        let mut slopes = [[0.0; 2]; 2];
        for (column, name) in NAMES.iter().enumerate() {
            let mut moved = scenario.clone();
            moved.truth[*name] += 1e-4;
            let Some(then) = drift(&moved, model) else {
                return;
            };
            (0..2).for_each(|row| slopes[row][column] = (then[row] - now[row]) / 1e-4);
        }
        let determinant = slopes[0][0] * slopes[1][1] - slopes[0][1] * slopes[1][0];
        scenario.truth["alpha_eq"] -= (slopes[1][1] * now[0] - slopes[0][1] * now[1]) / determinant;
        scenario.truth["de_eq"] -= (slopes[0][0] * now[1] - slopes[1][0] * now[0]) / determinant;
    }
}

fn flight(maneuver: &Maneuver, role: Role, label: &str, step: f64) -> Flight {
    let channels = maneuver.channels().iter();
    Flight {
        label: label.to_string(),
        role,
        time: maneuver.time().to_vec(),
        steps: Steps::Even(step),
        channels: channels
            .map(|(name, channel)| {
                (
                    name.clone(),
                    (channel.values.clone(), channel.unit.dimension),
                )
            })
            .collect(),
        own: Default::default(),
    }
}
