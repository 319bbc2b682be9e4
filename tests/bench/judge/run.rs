//! From a design and a seed to a line of the record.

use cpu_time::ThreadTime;
use serde::Serialize;
use trimtab_core::diagnose::Diagnosis;

use crate::case::{Setting, Sized};
use crate::design::{Design, Set};
use crate::job;
use crate::noise::Colour;
use crate::oracle;
use crate::random::Random;
use crate::replay::Replay;
use crate::strength::{hide_each_other, size, worth};
use crate::verdict::{Judge, Outcome};

/// One case and its answer.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Line {
    pub key: String,
    pub seed: u64,
    pub set: &'static str,
    pub aircraft: &'static str,
    /// The fault's kind; of pairs both, of nulls none.
    pub kind: String,
    pub truth: Vec<String>,
    pub strength: &'static str,
    pub colour: &'static str,
    /// SI
    pub sizes: Vec<f64>,
    /// Likelihood ratio of knowing it, where it has one.
    pub worth: Option<f64>,
    pub outcome: Outcome,
    pub verdict: &'static str,
    /// In the judge's words, the first first.
    pub named: Vec<String>,
    /// Members of the first's group.
    pub group: Vec<String>,
    /// Of what is in no catalogue: whether the answer points to where it is.
    pub points: Option<bool>,
    /// Whether the unmodelled force that is shown acts there.
    pub force_points: Option<bool>,
    /// Equation and likelihood ratio of the unmodelled force that is shown.
    pub force: Option<(String, f64)>,
    /// ln L that the catalogue's own edit of the truth falls short of the truth by.
    pub shortfall: Option<f64>,
    /// Why the truth was refused.
    pub refused: Option<String>,
    pub sentence: String,
    pub cpu: f64,
    pub samples: usize,
    pub step: f64,
}

/// How cases are made.
pub(crate) struct Manner<'r> {
    pub usual_names: bool,
    pub replay: Option<&'r Replay>,
    /// Tell each step of each diagnosis.
    pub steps: bool,
    /// Fit the catalogue's own edit of each truth, too.
    pub oracle: bool,
    /// No diagnosis: the flights and the oracle alone.
    pub dry: bool,
}

/// A third of all cases have coloured noise.
fn colour(seed: u64) -> Colour {
    if Random::new(seed, "colour").chance(1.0 / 3.0) {
        Colour::Coloured
    } else {
        Colour::White
    }
}

pub(crate) fn run(design: &Design, seed: u64, manner: &Manner<'_>) -> Line {
    let kind = design.kind();
    let setting = Setting::new(kind, seed, colour(seed), manner.usual_names, manner.replay);
    let faults = || design.faults.iter().map(|f| &setting.aircraft.faults[*f]);
    let mut line = Line {
        key: design.key.clone(),
        seed,
        set: design.set.name(),
        aircraft: kind.name,
        kind: faults().map(|f| f.kind).collect::<Vec<_>>().join("+"),
        truth: faults().map(|f| f.name.clone()).collect(),
        strength: if design.set == Set::Nulls {
            "none"
        } else {
            design.strength.name()
        },
        colour: setting.colour.name(),
        sizes: Vec::new(),
        worth: None,
        outcome: Outcome::Unseeable,
        verdict: "",
        named: Vec::new(),
        group: Vec::new(),
        points: None,
        force_points: None,
        force: None,
        shortfall: None,
        refused: None,
        sentence: String::new(),
        cpu: 0.0,
        samples: 0,
        step: setting.aircraft.sample,
    };
    let found: Option<Vec<(f64, Option<f64>)>> = (design.faults.iter())
        .map(|&fault| size(&setting, fault, design.strength))
        .collect();
    let Some(found) = found else {
        return line;
    };
    let sized: Sized = design
        .faults
        .iter()
        .zip(&found)
        .map(|(fault, (size, _))| (*fault, *size))
        .collect();
    line.sizes = found.iter().map(|(size, _)| *size).collect();
    line.worth = match found[..] {
        [(_, worth)] => worth,
        _ => worth(&setting, &sized),
    };
    if let ([(_, Some(one)), (_, Some(other))], Some(both)) = (&found[..], line.worth)
        && hide_each_other(*one, *other, both)
    {
        return line;
    }
    line.outcome = Outcome::NotTestable;
    let Some(recordings) = setting.flown(&sized, true) else {
        return line;
    };
    if manner.oracle && design.set == Set::Effects {
        let fault = &setting.aircraft.faults[design.faults[0]];
        line.shortfall = oracle::shortfall(&setting, &recordings, fault, line.sizes[0]);
    }
    line.samples = recordings.iter().map(|r| r.maneuver.len()).sum();
    if manner.dry {
        return line;
    }
    let before = ThreadTime::now();
    let answer = job::diagnose(&setting.document, &recordings, &mut |step| {
        if manner.steps {
            eprintln!("  {step:?}");
        }
    });
    line.cpu = before.elapsed().as_secs_f64();
    match answer {
        Err(why) => {
            line.outcome = Outcome::Failed;
            line.sentence = why;
        }
        Ok(diagnosis) => {
            let judge = Judge {
                setting: &setting,
                recordings: &recordings,
                set: design.set,
                sized: &sized,
            };
            line.outcome = judge.outcome(&diagnosis);
            line.points = (design.set == Set::Unknown).then(|| judge.points(&diagnosis));
            line.force_points = judge.force_points(&diagnosis);
            line.refused = judge.refusal(&diagnosis);
            tell(&mut line, &setting, &diagnosis);
        }
    }
    line
}

fn tell(line: &mut Line, setting: &Setting, diagnosis: &Diagnosis) {
    line.verdict = diagnosis.verdict.name();
    line.sentence = diagnosis.sentence.clone();
    let force = diagnosis.unmodelled.as_ref();
    line.force = force.map(|force| (setting.own(&force.equation), force.likelihood_ratio));
    line.named = diagnosis
        .effects
        .iter()
        .map(|e| setting.called(&e.effect))
        .collect();
    let first = diagnosis.effects.first();
    let members = first.iter().flat_map(|first| &first.group);
    line.group = members.map(|m| setting.called(&m.effect)).collect();
}
