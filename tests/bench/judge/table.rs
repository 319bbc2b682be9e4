//! What is printed: counts by kind, strength, aircraft and colour, wrong names, time.

use std::collections::BTreeMap;

use crate::run::Line;
use crate::verdict::Outcome;

const COLUMNS: [(&str, Outcome); 8] = [
    ("right", Outcome::Right),
    ("group", Outcome::Group),
    ("alias", Outcome::Alias),
    ("half", Outcome::Half),
    ("wrong", Outcome::Wrong),
    ("missed", Outcome::Missed),
    ("unexpl", Outcome::Unexplained),
    ("untest", Outcome::NotTestable),
];

fn is_case(line: &&Line) -> bool {
    line.outcome != Outcome::Unseeable
}

fn count(lines: &[&Line], outcome: Outcome) -> usize {
    lines.iter().filter(|line| line.outcome == outcome).count()
}

fn is_good(line: &&&Line) -> bool {
    matches!(
        line.outcome,
        Outcome::Right | Outcome::Group | Outcome::Alias
    )
}

fn row(name: &str, lines: &[&Line]) {
    let good = lines.iter().filter(is_good).count();
    print!("{name:34}{:6}", lines.len());
    for (_, outcome) in COLUMNS {
        match count(lines, outcome) {
            0 => print!("{:>8}", "·"),
            n => print!("{n:8}"),
        }
    }
    println!("{:8.1} %", 100.0 * good as f64 / lines.len().max(1) as f64);
}

fn table(title: &str, lines: &[&Line], by: impl Fn(&Line) -> String) {
    if lines.is_empty() {
        return;
    }
    print!("\n{title:34}{:>6}", "cases");
    COLUMNS.iter().for_each(|(name, _)| print!("{name:>8}"));
    println!("{:>10}", "good");
    let mut groups: BTreeMap<String, Vec<&Line>> = BTreeMap::new();
    for line in lines {
        groups.entry(by(line)).or_default().push(line);
    }
    groups.iter().for_each(|(name, lines)| row(name, lines));
    if groups.len() > 1 {
        row("all", lines);
    }
}

pub(crate) fn print(lines: &[Line]) {
    let of = |set: &str| -> Vec<&Line> {
        lines
            .iter()
            .filter(is_case)
            .filter(|line| line.set == set)
            .collect()
    };
    let nulls = of("nulls");
    table("nulls by colour", &nulls, |l| l.colour.to_string());
    table("nulls by aircraft", &nulls, |l| l.aircraft.to_string());
    let effects = of("effects");
    table("effects by kind", &effects, |l| l.kind.clone());
    table("effects by kind and strength", &effects, |l| {
        format!("{} {}", l.kind, l.strength)
    });
    table("effects by aircraft", &effects, |l| l.aircraft.to_string());
    table("effects by strength", &effects, |l| l.strength.to_string());
    table("effects by colour", &effects, |l| l.colour.to_string());
    table("pairs by aircraft", &of("pairs"), |l| {
        l.aircraft.to_string()
    });
    let unknown = of("unknown");
    table("in no catalogue, by kind", &unknown, |l| l.kind.clone());
    table("in no catalogue, by aircraft", &unknown, |l| {
        l.aircraft.to_string()
    });
    shortfalls(&effects);
    confusion(&effects);
    confusion(&unknown);
    wrong(lines);
    time(lines);
    summary(lines);
}

/// How far the catalogue's edits fall short of the truth, where that was asked for.
fn shortfalls(effects: &[&Line]) {
    let mut groups: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for line in effects {
        if let Some(shortfall) = line.shortfall {
            groups.entry(&line.kind).or_default().push(shortfall);
        }
    }
    if groups.is_empty() {
        return;
    }
    println!(
        "\n{:34}{:>10}{:>10}",
        "ln L short of the truth", "median", "most"
    );
    for (kind, mut all) in groups {
        all.sort_by(f64::total_cmp);
        println!(
            "{kind:34}{:10.1}{:10.1}",
            all[all.len() / 2],
            all[all.len() - 1]
        );
    }
}

/// What kinds were called, by their kind.
fn confusion(effects: &[&Line]) {
    if effects.is_empty() {
        return;
    }
    println!("\nwhat it is, and what it was called first (kinds):");
    let mut rows: BTreeMap<&str, BTreeMap<String, usize>> = BTreeMap::new();
    for line in effects {
        let called = match line.named.first() {
            Some(name) => name.split(' ').next().unwrap_or_default().to_string(),
            None => format!("({})", line.verdict),
        };
        *rows
            .entry(&line.kind)
            .or_default()
            .entry(called)
            .or_default() += 1;
    }
    for (kind, called) in rows {
        let mut called: Vec<_> = called.into_iter().collect();
        called.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let words: Vec<String> = called
            .iter()
            .map(|(name, count)| format!("{name} {count}"))
            .collect();
        println!("  {kind:22} {}", words.join(", "));
    }
}

fn wrong(lines: &[Line]) {
    let bad = |line: &&Line| {
        !matches!(
            line.outcome,
            Outcome::Right | Outcome::Group | Outcome::Alias | Outcome::Unseeable
        )
    };
    println!("\nnot right:");
    for line in lines.iter().filter(bad) {
        let named = if line.named.is_empty() {
            format!("({})", line.verdict)
        } else {
            line.named.join(" + ")
        };
        let why = line
            .refused
            .as_deref()
            .map_or(String::new(), |why| format!("; refused: {why}"));
        let failed = if line.outcome == Outcome::Failed {
            &line.sentence
        } else {
            ""
        };
        println!(
            "  {:11} {} [{} {}] {:?} LR {:.0}: {named}{why}{failed}",
            format!("{:?}", line.outcome),
            line.key,
            line.seed,
            line.colour,
            line.sizes,
            line.worth.unwrap_or(f64::NAN),
        );
    }
    let unseeable: Vec<&str> = (lines.iter())
        .filter(|line| line.outcome == Outcome::Unseeable)
        .map(|line| line.key.as_str())
        .collect();
    if !unseeable.is_empty() {
        println!(
            "\nno case, since no size makes it that strong: {}",
            unseeable.join(", ")
        );
    }
}

fn time(lines: &[Line]) {
    println!(
        "\n{:34}{:>10}{:>10}{:>10}",
        "CPU s of a diagnosis", "median", "90 %", "most"
    );
    let mut groups: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for line in lines.iter().filter(is_case) {
        groups.entry(line.aircraft).or_default().push(line.cpu);
    }
    for (name, mut times) in groups {
        times.sort_by(f64::total_cmp);
        let at = |share: f64| times[((times.len() - 1) as f64 * share).round() as usize];
        println!("{name:34}{:10.2}{:10.2}{:10.2}", at(0.5), at(0.9), at(1.0));
    }
}

fn share(part: usize, whole: usize) -> String {
    format!(
        "{part} of {whole} ({:.1} %)",
        100.0 * part as f64 / whole.max(1) as f64
    )
}

fn summary(lines: &[Line]) {
    let of = |set: &str| -> Vec<&Line> {
        lines
            .iter()
            .filter(is_case)
            .filter(|line| line.set == set)
            .collect()
    };
    let (nulls, effects, pairs) = (of("nulls"), of("effects"), of("pairs"));
    println!();
    if !nulls.is_empty() {
        println!(
            "false alarms: {}",
            share(count(&nulls, Outcome::Wrong), nulls.len())
        );
        println!(
            "nulls called unexplained: {}",
            share(count(&nulls, Outcome::Unexplained), nulls.len())
        );
    }
    if !effects.is_empty() {
        let strong: Vec<&Line> = effects
            .iter()
            .filter(|l| l.strength != "weak")
            .copied()
            .collect();
        let weak: Vec<&Line> = effects
            .iter()
            .filter(|l| l.strength == "weak")
            .copied()
            .collect();
        let good = |lines: &[&Line]| share(lines.iter().filter(is_good).count(), lines.len());
        println!(
            "clear and moderate: {}; weak: {}",
            good(&strong),
            good(&weak)
        );
        println!(
            "wrong first names: {}",
            share(count(&effects, Outcome::Wrong), effects.len())
        );
    }
    let unknown = of("unknown");
    if !unknown.is_empty() {
        println!(
            "in no catalogue, wrong name: {}",
            share(count(&unknown, Outcome::Wrong), unknown.len())
        );
        let points = unknown
            .iter()
            .filter(|line| line.points == Some(true))
            .count();
        println!(
            "in no catalogue, points to the right place: {}",
            share(points, unknown.len())
        );
        let shown = || unknown.iter().filter_map(|line| line.force_points);
        println!(
            "in no catalogue, the unmodelled force that is shown acts there: {}",
            share(shown().filter(|points| *points).count(), shown().count())
        );
    }
    if !pairs.is_empty() {
        println!(
            "pairs, both named: {}",
            share(count(&pairs, Outcome::Right), pairs.len())
        );
    }
}
