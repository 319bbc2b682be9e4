//! The judge of the diagnosis: an independent second simulator and its score.
//!
//! `cargo bench -p trimtab-core --bench judge -- --help` says what may be asked. A seed is a case: an aircraft with
//! derivatives, flights, inputs, sampling and noise of its own, and something that its declared model lacks, or
//! nothing. The truth is written out here and integrated at a tenth of the time between samples from continuous
//! inputs; it shares no code with Trimtab's simulator, nor with the edits by which Trimtab expresses effects.
//!
//! How strong an effect is says the likelihood ratio that it is worth to someone who knows it: clear 220 to 700,
//! moderate 70 to 180, weak 28 to 58; outliers are 30, 10 or 4 spikes a flight. A third of the cases have noise with
//! the colour of real residuals. An answer is good when kind and target are named first, singly or in a group, or when
//! the oracle finds that what was named fits within three units of ln L of the truth.
//!
//! Seeds 1 to 999 may be used while tuning the diagnosis. Those from 1000 on are for judging alone: who has looked at
//! one of them must not tune with it.

#[path = "judge/air_faults.rs"]
mod air_faults;
#[path = "judge/aircraft/mod.rs"]
mod aircraft;
#[path = "judge/case.rs"]
mod case;
#[path = "judge/design.rs"]
mod design;
#[path = "judge/fault.rs"]
mod fault;
#[path = "judge/fly.rs"]
mod fly;
#[path = "judge/force.rs"]
mod force;
#[path = "judge/force_faults.rs"]
mod force_faults;
#[path = "judge/inputs.rs"]
mod inputs;
#[path = "judge/job.rs"]
mod job;
#[path = "judge/likelihood.rs"]
mod likelihood;
#[path = "judge/motion.rs"]
mod motion;
#[path = "judge/names.rs"]
mod names;
#[path = "judge/noise.rs"]
mod noise;
#[path = "judge/options.rs"]
mod options;
#[path = "judge/oracle.rs"]
mod oracle;
#[path = "judge/plant.rs"]
mod plant;
#[path = "judge/polish.rs"]
mod polish;
#[path = "judge/random.rs"]
mod random;
#[path = "judge/record.rs"]
mod record;
#[path = "judge/replay.rs"]
mod replay;
#[path = "judge/run.rs"]
mod run;
#[path = "judge/sensor_faults.rs"]
mod sensor_faults;
#[path = "judge/strength.rs"]
mod strength;
#[path = "judge/surface_faults.rs"]
mod surface_faults;
#[path = "judge/table.rs"]
mod table;
#[path = "judge/verdict.rs"]
mod verdict;

use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use design::{Design, Set, designs, of_seed};
use options::{HELP, Options, parse};
use replay::Replay;
use run::{Line, Manner, run};

fn main() {
    let options = match parse(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(why) => {
            eprintln!("{why}\n\n{HELP}");
            std::process::exit(2);
        }
    };
    let sets = Set::ALL.map(|set| (set, designs(set, &options.only)));
    if options.list {
        for (set, designs) in &sets {
            println!("{} ({})", set.name(), designs.len());
            designs
                .iter()
                .for_each(|design| println!("  {}", design.key));
        }
        return;
    }
    let cases: Vec<(Design, u64)> = (options.seeds.0..options.seeds.1)
        .filter_map(|seed| {
            let designs = &sets
                .iter()
                .find(|(set, _)| *set == set_of(seed, &options))?
                .1;
            (!designs.is_empty()).then(|| (of_seed(designs, seed).clone(), seed))
        })
        .collect();
    let lines = judged(&cases, &options);
    table::print(&lines);
    println!("{}", std::env::args().collect::<Vec<_>>().join(" "));
}

fn set_of(seed: u64, options: &Options) -> Set {
    options.set.unwrap_or(match seed % 10 {
        0..3 => Set::Nulls,
        3..8 => Set::Effects,
        8 => Set::Pairs,
        _ => Set::Unknown,
    })
}

/// Runs the cases, each in a pool of one thread, so that the thread's time is the diagnosis's.
fn judged(cases: &[(Design, u64)], options: &Options) -> Vec<Line> {
    let replay = Replay::read();
    let manner = Manner {
        usual_names: options.usual_names,
        replay: replay.as_ref(),
        steps: options.steps,
        oracle: options.oracle,
        dry: options.dry,
    };
    let file = options
        .json
        .as_ref()
        .map(|path| Mutex::new(std::fs::File::create(path).expect("a file")));
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Line)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..options.threads {
            scope.spawn(|| {
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(1)
                    .build()
                    .expect("a pool");
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some((design, seed)) = cases.get(number) else {
                        break;
                    };
                    let line = pool.install(|| run(design, *seed, &manner));
                    let named = if line.named.is_empty() {
                        line.verdict.to_string()
                    } else {
                        line.named.join(" + ")
                    };
                    eprintln!(
                        "{}/{} seed {seed} {} {}: {:?}, {named} ({:.1} s)",
                        number + 1,
                        cases.len(),
                        line.key,
                        line.colour,
                        line.outcome,
                        line.cpu
                    );
                    if let Some(file) = &file {
                        let text = serde_json::to_string(&line).expect("JSON");
                        writeln!(file.lock().expect("the file"), "{text}").expect("written");
                    }
                    done.lock().expect("the lines").push((number, line));
                }
            });
        }
    });
    let mut lines = done.into_inner().expect("the lines");
    lines.sort_by_key(|(number, _)| *number);
    lines.into_iter().map(|(_, line)| line).collect()
}
