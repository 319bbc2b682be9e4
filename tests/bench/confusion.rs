//! The confusion matrix of the diagnosis: every effect of the catalogue, put undeclared into simulated flights at
//! three strengths, with white and with coloured noise; and flights with nothing undeclared.
//!
//! `cargo bench --bench confusion [cases] [empty] [first seed] [pairs] [aircraft, or part of an effect's name]`: `cases` for
//! each effect, strength and colour; `empty` ones for each aircraft and colour; `pairs` of two moderate effects at once. The strength of an effect is the likelihood ratio that it is worth to
//! who knows it: 30 (weak), 100 (moderate), 300 (clear). Seeds below 1 000 000 are for tuning; the figure is made with
//! others.

#[path = "confusion/aircraft.rs"]
mod aircraft;
#[path = "confusion/strength.rs"]
mod strength;
#[path = "confusion/tally.rs"]
mod tally;

use std::ops::ControlFlow;

use rayon::prelude::*;
use trimtab::diagnose::{Conclusion, Diagnosis, Effect, diagnose};
use trimtab::simulate::NoiseColour;

use aircraft::{Aircraft, aircraft};
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
    let part = arguments
        .iter()
        .find(|a| a.parse::<u64>().is_err())
        .cloned()
        .unwrap_or_default();
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
    let chosen = names.iter().find(|name| **name == part).copied();
    let part = if chosen.is_some() {
        String::new()
    } else {
        part
    };
    for aircraft in aircraft()
        .into_iter()
        .filter(|aircraft| chosen.is_none_or(|name| name == aircraft.name))
    {
        for (colour_name, colour) in &colours {
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
                    let diagnosis =
                        run(&aircraft, &[(effect, *size)], colour, seed + number as u64);
                    Answer::of(
                        &aircraft,
                        colour_name,
                        strength,
                        Some((effect, *size)),
                        diagnosis.as_ref(),
                    )
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
                    let diagnosis = run(&aircraft, &[], colour, seed + 500_000 + number);
                    Answer::of(&aircraft, colour_name, "empty", None, diagnosis.as_ref())
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
            let diagnosis = run(aircraft, &[(&a.0, a.2), (&b.0, b.2)], colour, seed + number);
            Both::of(aircraft, [a.0.clone(), b.0.clone()], diagnosis.as_ref())
        })
        .collect()
}

/// Flies the aircraft with effects that the declared model lacks, and diagnoses it.
fn run(
    aircraft: &Aircraft,
    effects: &[(&Effect, f64)],
    colour: &NoiseColour,
    seed: u64,
) -> Option<Diagnosis> {
    let case = aircraft.case(effects, Some(colour), seed)?;
    match diagnose(&case, &mut |_| ControlFlow::Continue(())) {
        Ok(Conclusion { diagnosis, .. }) => Some(diagnosis),
        Err(_) => None,
    }
}
