//! The confusion matrix of the diagnosis: every effect of the catalogue, put undeclared into simulated flights at
//! three strengths, with white and with coloured noise; and flights with nothing undeclared.
//!
//! `cargo bench --bench confusion [cases] [empty] [first seed] [pairs] [aircraft] [white|coloured] [part of an effect's
//! name]`: `cases` for each effect, strength and colour; `empty` ones for each aircraft and colour; `pairs` of two
//! moderate effects at once, for each too. The strength of an effect is the likelihood ratio that it is worth to who knows it: 30 (weak), 100
//! (moderate), 300 (clear); outliers are 4, 10 or 30 spikes of ten noise deviations. Seeds below 1 000 000 are for tuning;
//! the figure is made with others. The true model that
//! predictions are compared with is one of output error: what it lacks where the truth is process noise or outliers, it
//! lacks too. With CONFUSION_STEPS in the environment each step of each diagnosis is told.

#[path = "confusion/aircraft.rs"]
mod aircraft;
#[path = "confusion/reached.rs"]
mod reached;
#[path = "confusion/strength.rs"]
mod strength;
#[path = "confusion/tally.rs"]
mod tally;

use std::ops::ControlFlow;

use rayon::prelude::*;
use trimtab_core::diagnose::{Conclusion, Diagnosis, Effect, Step, diagnose};
use trimtab_core::simulate::NoiseColour;

use aircraft::{Aircraft, Flown, aircraft};
use reached::Reached;
use tally::{Answer, Both, Tally};

const STRENGTHS: [(&str, f64); 3] = [("weak", 30.0), ("moderate", 100.0), ("clear", 300.0)];

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let mut numbers = arguments.iter().filter_map(|a| a.parse::<u64>().ok());
    let mut next = |otherwise: u64| numbers.next().unwrap_or(otherwise);
    let (cases, empty, seed, pairs) = (next(1), next(100), next(1_000_000), next(50));
    let colours = [
        ("white", NoiseColour::White),
        (
            "coloured",
            NoiseColour::FirstOrder {
                correlation_time: 0.1,
            },
        ),
    ];
    let mut tally = Tally::default();
    let mut both: Vec<Both> = Vec::new();
    let names: Vec<&str> = aircraft().iter().map(|aircraft| aircraft.name).collect();
    let words = || arguments.iter().filter(|a| a.parse::<u64>().is_err());
    let chosen = words().find_map(|word| names.iter().find(|name| *name == word).copied());
    let is_choice = |word: &str| names.contains(&word) || ["white", "coloured"].contains(&word);
    let part = words().find(|word| !is_choice(word));
    let part = part.cloned().unwrap_or_default();
    let only = words().find(|word| colours.iter().any(|(name, _)| name == word));
    for aircraft in aircraft()
        .into_iter()
        .filter(|aircraft| chosen.is_none_or(|name| name == aircraft.name))
    {
        for (colour_name, colour) in colours
            .iter()
            .filter(|(name, _)| only.is_none_or(|only| only == name))
        {
            let effects: Vec<Effect> = aircraft
                .effects()
                .into_iter()
                .filter(|e| e.name().contains(&part))
                .collect();
            let sized: Vec<(Effect, &str, f64)> = (effects.par_iter())
                .flat_map_iter(|effect| {
                    let sizes = strength::sizes(
                        &aircraft,
                        effect,
                        colour,
                        &STRENGTHS.map(|(_, ratio)| ratio),
                    );
                    STRENGTHS
                        .iter()
                        .zip(sizes)
                        .filter_map(|((name, _), size)| Some((effect.clone(), *name, size?)))
                        .collect::<Vec<_>>()
                })
                .collect();
            let jobs: Vec<(&(Effect, &str, f64), u64)> = sized
                .iter()
                .flat_map(|job| (0..cases).map(move |case| (job, case)))
                .collect();
            let answers: Vec<Answer> = (jobs.par_iter().enumerate())
                .map(|(number, ((effect, strength, size), _))| {
                    let effects = [(effect, *size)];
                    let seed = seed + number as u64;
                    let flown = run(&aircraft, &effects, colour, seed);
                    let reached = (flown.as_ref()).map(|(flown, diagnosis)| {
                        Reached::of(&aircraft, flown, &effects, diagnosis)
                    });
                    let diagnosis = flown.as_ref().map(|(_, diagnosis)| diagnosis);
                    let truth = Some((effect, *size, reached.unwrap_or_default()));
                    Answer::of(&aircraft, colour_name, strength, truth, diagnosis, seed)
                })
                .collect();
            eprintln!(
                "{} {colour_name}: {} cases done",
                aircraft.name,
                answers.len()
            );
            tally.extend(answers);
            both.extend(two_at_once(
                &aircraft,
                &sized,
                colour,
                seed + 800_000,
                pairs,
            ));
            if !"empty".contains(&part) && !part.is_empty() {
                continue;
            }
            let answers: Vec<Answer> = (0..empty)
                .into_par_iter()
                .map(|number| {
                    let seed = seed + 500_000 + number;
                    let flown = run(&aircraft, &[], colour, seed);
                    let diagnosis = flown.as_ref().map(|(_, diagnosis)| diagnosis);
                    Answer::of(&aircraft, colour_name, "empty", None, diagnosis, seed)
                })
                .collect();
            tally.extend(answers);
        }
    }
    tally.print();
    Both::print(&both);
}

/// Pairs of moderate effects, at places of the list that have nothing to do with each other.
fn two_at_once(
    aircraft: &Aircraft,
    sized: &[(Effect, &str, f64)],
    colour: &NoiseColour,
    seed: u64,
    pairs: u64,
) -> Vec<Both> {
    let moderate: Vec<&(Effect, &str, f64)> = sized
        .iter()
        .filter(|(_, strength, _)| *strength == "moderate")
        .collect();
    if moderate.len() < 2 {
        return Vec::new();
    }
    (0..pairs)
        .into_par_iter()
        .map(|number| {
            let n = moderate.len();
            let first = (number as usize * 7919) % n;
            let second = (first + 1 + (number as usize * 104_729) % (n - 1)) % n;
            let (a, b) = (moderate[first], moderate[second]);
            let flown = run(aircraft, &[(&a.0, a.2), (&b.0, b.2)], colour, seed + number);
            let diagnosis = flown.as_ref().map(|(_, diagnosis)| diagnosis);
            Both::of(aircraft, [a.0.clone(), b.0.clone()], diagnosis)
        })
        .collect()
}

/// Flies the aircraft with effects that the declared model lacks, and diagnoses it.
fn run(
    aircraft: &Aircraft,
    effects: &[(&Effect, f64)],
    colour: &NoiseColour,
    seed: u64,
) -> Option<(Flown, Diagnosis)> {
    let flown = aircraft.flown(effects, Some(colour), seed)?;
    let mut tell = |step: Option<&Step>| {
        if let (Some(step), true) = (step, std::env::var_os("CONFUSION_STEPS").is_some()) {
            eprintln!("seed {seed}: {step:?}");
        }
        ControlFlow::Continue(())
    };
    match diagnose(&flown.case, &mut tell) {
        Ok(Conclusion { diagnosis, .. }) => Some((flown, diagnosis)),
        Err(_) => None,
    }
}
