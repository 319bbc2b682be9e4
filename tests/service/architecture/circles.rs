//! Circles between the entries of a folder: its files, and its folders with all that is in them.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::modules::Use;

/// One round of imports, each from an entry to the next.
#[derive(Debug)]
pub(super) struct Circle<'a> {
    pub(super) folder: String,
    /// The imports of each step. The last step has the fewest: it is the one to cut.
    pub(super) steps: Vec<Vec<&'a Use>>,
}

/// From an entry to another one of the same folder: the imports that say so.
type Arrows<'a> = BTreeMap<(&'a str, &'a str), Vec<&'a Use>>;

/// All circles, from the shortest on; after each, the step that closes it is taken away.
pub(super) fn circles<'a>(files: &BTreeSet<&str>, uses: &'a [Use]) -> Vec<Circle<'a>> {
    let mut found = Vec::new();
    for folder in folders(files) {
        let mut arrows = arrows(&folder, uses);
        while let Some(circle) = shortest(&arrows) {
            let steps: Vec<_> = circle.iter().map(|step| arrows[step].clone()).collect();
            arrows.remove(circle.last().expect("a circle has steps"));
            let folder = folder.clone();
            found.push(Circle { folder, steps });
        }
    }
    found
}

fn folders(files: &BTreeSet<&str>) -> BTreeSet<String> {
    let above = |file: &&str| {
        let slashes = file.match_indices('/');
        let folders = slashes.map(|(at, _)| file[..=at].to_owned());
        folders.collect::<Vec<_>>()
    };
    files.iter().flat_map(above).collect()
}

fn arrows<'a>(folder: &str, uses: &'a [Use]) -> Arrows<'a> {
    let mut arrows = Arrows::new();
    for used in uses {
        if let (Some(from), Some(to)) = (entry(folder, &used.from), entry(folder, &used.to))
            && from != to
        {
            arrows.entry((from, to)).or_default().push(used);
        }
    }
    arrows
}

/// The entry of a folder in which a file is.
fn entry<'a>(folder: &str, file: &'a str) -> Option<&'a str> {
    let inside = file.strip_prefix(folder)?;
    let end = inside.find('/').unwrap_or(inside.len());
    Some(&file[..folder.len() + end])
}

/// The steps of a shortest circle, turned so that the one with the fewest imports is the last.
fn shortest<'a>(arrows: &Arrows<'a>) -> Option<Vec<(&'a str, &'a str)>> {
    let entries: BTreeSet<&str> = arrows.keys().map(|(from, _)| *from).collect();
    let circles = entries
        .into_iter()
        .filter_map(|entry| back_to(entry, arrows));
    let mut circle = circles.min_by_key(Vec::len)?;
    let fewest = (0..circle.len()).min_by_key(|&at| arrows[&circle[at]].len())?;
    circle.rotate_left(fewest + 1);
    Some(circle)
}

/// The shortest way from an entry back to it.
fn back_to<'a>(start: &'a str, arrows: &Arrows<'a>) -> Option<Vec<(&'a str, &'a str)>> {
    let mut reached = BTreeMap::new();
    let mut pending = VecDeque::from([start]);
    while let Some(at) = pending.pop_front() {
        for &(from, to) in arrows.range((at, "")..).map(|(arrow, _)| arrow) {
            if from != at {
                break;
            }
            if !reached.contains_key(to) {
                reached.insert(to, (from, to));
                pending.push_back(to);
            }
        }
    }
    let mut way = vec![*reached.get(start)?];
    while way[way.len() - 1].0 != start {
        way.push(reached[way[way.len() - 1].0]);
    }
    way.reverse();
    Some(way)
}

impl std::fmt::Display for Circle<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (last, steps) = self.steps.split_last().expect("a circle has steps");
        writeln!(f, "{}: a circle is closed by", self.folder)?;
        write_step(f, last)?;
        writeln!(f, "  because of")?;
        steps.iter().try_for_each(|step| write_step(f, step))
    }
}

fn write_step(f: &mut std::fmt::Formatter<'_>, step: &[&Use]) -> std::fmt::Result {
    for used in step.iter().take(3) {
        writeln!(f, "    {used}")?;
    }
    match step.len().saturating_sub(3) {
        0 => Ok(()),
        more => writeln!(f, "    and {more} more"),
    }
}
