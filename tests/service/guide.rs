//! The guide: its pages and links, what of it is made from the code, and every command in it.
//!
//! Pages that are made from the code are compared with it; TRIMTAB_WRITE_GUIDE=1 writes them anew.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::process::Process;
use crate::common::server::Server;
use trimtab::http::code::Code;
use trimtab::model::EditKind;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide")
}

fn page(name: &str) -> String {
    std::fs::read_to_string(folder().join(format!("{name}.md"))).expect("a page")
}

fn pages() -> BTreeMap<String, String> {
    let entries = std::fs::read_dir(folder()).expect("the guide");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let of = |path: PathBuf| {
        let name = path.file_stem()?.to_str()?.to_string();
        (path.extension()? == "md").then(|| (name.clone(), page(&name)))
    };
    paths.filter_map(of).collect()
}

/// Values of an attribute in HTML.
fn values<'h>(html: &'h str, attribute: &str) -> Vec<&'h str> {
    let begin = format!("{attribute}=\"");
    let parts = html.split(begin.as_str()).skip(1);
    parts
        .map(|part| part.split('"').next().expect("an end"))
        .collect()
}

#[tokio::test]
async fn every_page_is_served_and_every_link_leads_somewhere() {
    let server = Server::start_with(trimtab::http::Config::default(), 0).await;
    let mut pending = vec!["/guide".to_string()];
    let mut seen: BTreeMap<String, String> = BTreeMap::new();
    let mut wanted: BTreeSet<(String, String)> = BTreeSet::new();
    while let Some(path) = pending.pop() {
        if seen.contains_key(&path) {
            continue;
        }
        let answer = server.get(&path).await;
        assert_eq!(answer.status, 200, "{path}");
        let is_of_the_guide = path.starts_with("/guide") && !path.contains("/pictures/");
        let text = if is_of_the_guide {
            answer.text()
        } else {
            String::new()
        };
        for link in values(&text, "href")
            .into_iter()
            .chain(values(&text, "src"))
        {
            let (to, anchor) = link.split_once('#').unwrap_or((link, ""));
            let to = if to.is_empty() { path.as_str() } else { to };
            if to.starts_with("http") {
                assert!(
                    to.starts_with("http://127.0.0.1:8300"),
                    "{path}: {link} needs a network"
                );
                continue;
            }
            assert!(to.starts_with('/'), "{path}: {link}");
            if !anchor.is_empty() {
                wanted.insert((to.to_string(), anchor.to_string()));
            }
            pending.push(to.to_string());
        }
        seen.insert(path, text);
    }
    for (path, anchor) in wanted {
        if path.starts_with("/guide") {
            let ids = values(&seen[&path], "id");
            assert!(ids.contains(&anchor.as_str()), "{path} has no #{anchor}");
        }
    }
    for name in pages().keys().filter(|name| *name != "index") {
        assert!(
            seen.contains_key(&format!("/guide/{name}")),
            "no link leads to {name}"
        );
    }
    assert_eq!(server.get("/guide/nothing").await.status, 404);
}

/// Compares a page with what the code makes of it.
#[track_caller]
fn is_as_made(name: &str, made: &str) {
    if std::env::var_os("TRIMTAB_WRITE_GUIDE").is_some() {
        std::fs::write(folder().join(format!("{name}.md")), made).expect("written");
    }
    assert!(
        page(name) == made,
        "src/guide/{name}.md is not what the code says; look at the difference after: TRIMTAB_WRITE_GUIDE=1 cargo test --test service guide::"
    );
}

#[test]
fn the_page_of_problems_is_that_of_the_code() {
    let mut made = "# Problems\n\nWhatever is refused over HTTP is answered with `application/problem+json` (RFC 9457): `code` is one of these, \
        `detail` says what is\nwrong with this request, and `errors` has every place that is at fault. The command line prints the same.\n\n\
        | code | status | meaning |\n|---|---|---|\n"
        .to_string();
    for code in Code::ALL {
        let _ = writeln!(
            made,
            "| `{}` | {} | {} |",
            code.name(),
            code.status().as_u16(),
            code.meaning()
        );
    }
    is_as_made("problems", &made);
}

/// Formulas stand where the kinds are declared.
#[test]
fn the_page_of_effects_is_that_of_the_code() {
    let source = include_str!("../../src/core/model/edit/written.rs");
    let declared = source
        .split("pub enum EditKind {")
        .nth(1)
        .expect("the kinds");
    let declared = declared.split("\n}").next().expect("an end");
    let formulas: Vec<&str> = declared
        .lines()
        .filter_map(|line| line.trim().strip_prefix("/// "))
        .collect();
    assert_eq!(formulas.len(), EditKind::ALL.len());
    let mut made = "# Effects\n\nWhat a model may lack. Each is an edit of a model document: in a job under `edits`, on the command line \
        `--edit KIND:TARGET[:TERM]`,\nas in `--edit sensor_delay:q`. A diagnosis tries them by itself; `trimtab simulate` puts them into a maneuver \
        (`--effect\nsensor_delay:q=0.1`). Each adds parameters with units, start values and physical bounds. What `target` and `term` mean is in the\n\
        [API](/docs/), under `Edit`.\n\nIn formulas y is an output, u an input, x a state, δ what the equations see of an input, and all else is \
        estimated.\n\n| kind | formula |\n|---|---|\n"
        .to_string();
    for (kind, formula) in EditKind::ALL.iter().zip(formulas) {
        let _ = writeln!(made, "| `{}` | {formula} |", kind.name());
    }
    made += "\nBeside these a diagnosis tries two treatments of the data: process noise (turbulence) and outliers of a sensor.\n\n\
        ```sh\ntrimtab fit data/effects/elevator-backlash-fit.csv -m short-period --edit backlash:de\n```\n";
    is_as_made("effects", &made);
}

#[test]
fn the_page_of_commands_is_that_of_the_program() {
    let help = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        for (name, _) in std::env::vars().filter(|(name, _)| name.starts_with("TRIMTAB_")) {
            command.env_remove(name);
        }
        let output = command
            .args(words)
            .arg("--help")
            .output()
            .expect("the program");
        String::from_utf8(output.stdout).expect("text")
    };
    let commands = |text: &str| -> Vec<String> {
        let list = text.split("Commands:\n").nth(1).unwrap_or_default();
        let lines = list.lines().take_while(|line| line.starts_with("  "));
        let names = lines.filter_map(|line| line.split_whitespace().next());
        names
            .filter(|name| *name != "help")
            .map(str::to_string)
            .collect()
    };
    let all = help(&[]);
    let mut made = "# Commands\n\nWhat `trimtab COMMAND --help` says. Where a setting has a variable of the environment, it stands behind `env`.\n".to_string();
    for name in commands(&all) {
        let text = help(&[&name]);
        let _ = write!(
            made,
            "\n## trimtab {name}\n\n```text\n{}\n```\n",
            text.trim_end()
        );
        for part in commands(&text) {
            let text = help(&[&name, &part]);
            let _ = write!(
                made,
                "\n### trimtab {name} {part}\n\n```text\n{}\n```\n",
                text.trim_end()
            );
        }
    }
    is_as_made("commands", &made);
}

#[test]
fn the_confusion_matrix_is_what_the_judge_said() {
    let said = include_str!("../bench/judge.txt");
    let (head, matrix): (Vec<&str>, Vec<&str>) =
        said.lines().partition(|line| line.starts_with('#'));
    let head: Vec<&str> = head
        .iter()
        .map(|line| line.trim_start_matches(['#', ' ']))
        .collect();
    let mut made = "# Confusion matrix\n\nHow often a diagnosis is right says a judge: a second simulator that shares no code with the effects of the catalogue, \
        with aircraft\nof its own, names that no catalog has, and inputs of real flights. No tuning saw these cases.\n\n\
        Columns: `right`, the effect is named first and alone; `group`, it is in the group that is named first; `alias`, another is named\nthat \
        fits as well; `half`, one of two; `wrong`, another is named; `missed`, nothing is; `unexpl`, the verdict is unexplained;\n`untest`, not \
        testable; `good`, the share of right, group and alias.\n\n```text\n"
        .to_string();
    let _ = write!(
        made,
        "{}\n\n{}\n```\n",
        head.join("\n"),
        matrix.join("\n").trim()
    );
    is_as_made("confusion", &made);
}

/// The code blocks of a page whose info string is that.
fn blocks(text: &str, info: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open: Option<(String, String)> = None;
    for line in text.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(begins)) => open = Some((begins.to_string(), String::new())),
            (Some(_), Some(_)) => {
                let (of, code) = open.take().expect("open");
                if of == info {
                    found.push(code);
                }
            }
            (Some((_, code)), None) => {
                code.push_str(line);
                code.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a code block does not end");
    found
}

/// All shell blocks of a page, one behind the other in one shell, with the folder `data` and a server.
fn run(name: &str, text: &str, server: &str) {
    let blocks = blocks(text, "sh");
    if blocks.is_empty() {
        return;
    }
    let directory = tempfile::tempdir().expect("a directory");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::os::unix::fs::symlink(root.join("data"), directory.path().join("data")).expect("a link");
    let mut script = "set -euo pipefail\n".to_string();
    for (number, block) in blocks.iter().enumerate() {
        let _ = write!(script, "echo '== block {}' >&2\n{block}", number + 1);
    }
    let script = script.replace("http://127.0.0.1:8300", server);
    let program = Path::new(env!("CARGO_BIN_EXE_trimtab"));
    let path = format!(
        "{}:{}",
        program.parent().expect("a folder").display(),
        std::env::var("PATH").expect("a path")
    );
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(directory.path())
        .env("PATH", path)
        .env("TRIMTAB_SERVER", server)
        .env("TRIMTAB_DATABASE", directory.path().join("trimtab.db"))
        .output()
        .expect("bash");
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    assert!(
        output.status.success(),
        "src/guide/{name}.md:\n{out}\n{err}"
    );
}

#[test]
fn every_command_of_the_guide_runs() {
    let directory = tempfile::tempdir().expect("a directory");
    let server = Process::start(directory.path(), 2);
    let mut pages = pages();
    pages.insert("../../README".to_string(), commands_of_the_readme());
    std::thread::scope(|scope| {
        for (name, text) in &pages {
            scope.spawn(|| run(name, text, &server.url));
        }
    });
}

/// What `README.md` has a reader type, but for what starts a server: a block of shell.
fn commands_of_the_readme() -> String {
    let readme = include_str!("../../README.md");
    let typed = readme
        .lines()
        .filter_map(|line| line.strip_prefix("    trimtab "));
    let commands: Vec<&str> = typed.filter(|line| !line.starts_with("serve")).collect();
    assert!(!commands.is_empty());
    format!("```sh\ntrimtab {}\n```\n", commands.join("\ntrimtab "))
}

/// A block is of a kind that is run or looked at somewhere, or is only shown.
#[test]
fn code_blocks_say_what_they_are() {
    let known = [
        "sh",
        "sh server",
        "python",
        "text",
        "json",
        "toml",
        "toml model",
    ];
    for (name, text) in &pages() {
        let begins = text.lines().filter_map(|line| line.strip_prefix("```"));
        for info in begins.filter(|info| !info.is_empty()) {
            assert!(
                known.contains(&info),
                "src/guide/{name}.md: a block of '{info}'"
            );
        }
        for block in blocks(text, "json") {
            let read: Result<serde_json::Value, _> = serde_json::from_str(&block);
            assert!(read.is_ok(), "src/guide/{name}.md: {read:?} in\n{block}");
        }
        for block in blocks(text, "toml") {
            let read: Result<toml::Table, _> = toml::from_str(&block);
            assert!(read.is_ok(), "src/guide/{name}.md: {read:?} in\n{block}");
        }
        for block in blocks(text, "toml model") {
            let document: trimtab::model::ModelDocument =
                toml::from_str(&block).expect("a document");
            let compiled = trimtab::model::Model::compile(&document);
            assert!(
                compiled.is_ok(),
                "src/guide/{name}.md: {:?}",
                compiled.err()
            );
        }
    }
}
