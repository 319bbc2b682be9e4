//! Trimtab estimates aircraft parameters from flight-test maneuvers, as a service.
//!
//! What is estimated, and how, is the crate [`trimtab_core`]; its rooms stand here under their own names. Around them:
//! what keeps jobs and recordings ([`store`]), who runs jobs ([`work`]), who is told of their end ([`webhook`]), how
//! they are asked for ([`http`], [`cli`]), how their results look ([`dashboard`]). Arrows go one way: `store → job`,
//! `work → store`, `webhook → store`, `http → store, job, ingest, dashboard, webhook`. `http` and `work` meet only at
//! the store.
//!
//! # Recipes
//!
//! **Build and run.** `cargo build` (Rust as `rust-toolchain.toml` says, and a C compiler for SQLite);
//! `cargo run -- serve` serves <http://127.0.0.1:8300>, `cargo run -- demo` shows what it can do.
//!
//! **Test.** `tests/run` is everything; `tests/quick <room>` formats, runs clippy and passes what is wanted while one works on
//! a room (a test by name, too: `service::pages`). One kind: `cargo test --lib` (beside the code, core and service),
//! `--test numbers` and `--test ingest` (the core), `--test store` and `--test service` (the service). One subject: its
//! module behind the kind, `cargo test --test numbers effects::`. Tests of PostgreSQL and of pages run behind
//! `tests/postgres` and `tests/browser`, as in `tests/browser cargo test --test service pages::`.
//!
//! **Add an effect.** An effect is an edit of a model document with parameters more, without effect at a value of them.
//! 1. `src/core/model/edit/written.rs`: a variant of `EditKind` whose doc comment is its formula; in `ALL` and `name`; in
//!    `Edit::apply` of `mod.rs` beside it. What `target` and `term` mean for it goes into the doc comments of `Edit`.
//! 2. Beside it, in the file of its subject (`sensors.rs`, `inputs.rs`, `dynamics.rs`, `wind.rs`, ...): a function over the
//!    `Sheet`, which looks the target up, chooses a free name, substitutes, and adds the parameters, each
//!    with what it is for (`AddedRole`), unit, start and, where it has one, physical range.
//! 3. `src/core/diagnose/candidates`: in the file of its subject, for which quantities it is a candidate (as few as make sense:
//!    no model of the catalog may have more than 300); in `ranges.rs`, which sizes are usual (SI; no row: not bounded). Above, `starts.rs`: where its fit begins, if one linear step does not tell; `sentence.rs`: its words.
//! 4. `tests/numbers/effects.rs`: a row of `cases` (without effect the same outputs, with effect others), and in
//!    `effects_go_the_right_way` that they change the way they should.
//!    `cargo test --test numbers -- effects:: absence::` (the latter tries each kind on six models by itself; what its `term`
//!    may be goes into `edits` in `absence.rs`), `cargo test --lib -- edit:: candidates::`.
//! 5. `tests/bench/confusion/strength.rs`: a first guess of its size; its word in `tests/fuzz/dictionaries/job.dict`. The page
//!    of effects in the guide (below), and the API document: `cargo run -- openapi > openapi/trimtab.json`.
//!
//! **Add a model to the catalog.**
//! 1. `src/core/model/catalog/<name>.toml`: the document; `source` names paper and equation (eq.).
//! 2. `src/core/model/catalog/mod.rs`: a row of `DOCUMENTS`.
//! 3. `tests/numbers/catalog/<name>.toml`: a scenario with the truth in it; `tests/numbers/catalog.rs` simulates it and
//!    must find that truth. `cargo test --test numbers catalog::`, and `--lib catalog::`.
//! 4. The table of models in `src/guide/models.md`.
//!
//! **Add a reader of a file format.**
//! 1. `src/core/ingest/<format>.rs`: `read(bytes, limits)`, for a format that says names and units itself, after
//!    `json.rs`; `read(bytes, mapping, limits)`, for one that does not, after `ascii.rs` (text), or `map` in `mat/mod.rs`
//!    (binary: without a mapping it answers `MAPPING_NEEDED`, and what there is). Count before you build (`Limits`),
//!    then make a `Recording` (`recording.rs`: columns by name with units) and call its `into_maneuver`, or hand a table of
//!    numbers, an `Archive`, to `Mapping::apply`. A fault names its place and the remedy; its code is one of `code` in
//!    `fault.rs`, or a new row there.
//!    A log of messages, each kind with its own times, makes a `Table` of each (`messages/`, after `ulog/` or `dataflash/`);
//!    groups of channels that say units and times make `Groups` (`groups/`, after `tdms/`); a table whose cells are numbers
//!    already makes `Columns`, which go the way of a table of text (`columns.rs`, after `parquet/`).
//! 2. `src/core/ingest/contents.rs`: a variant of `Contents`, and how a file is known: by its first bytes a variant of `Kind`
//!    in `recognition.rs` (and its line among the foreign ones goes); its file ending in `Format::from_extension`;
//!    text by a variant of `Format` in `format.rs`, with its media type. Its line in `read_recording` in `mod.rs`. HTTP and command line go by these.
//! 3. Tests beside the reader; a good file in `no_damage_to_a_file_panics` in `mod.rs`, or, where a mapping is needed, a test
//!    like `no_damage_to_a_mat_file_panics` in `tests/ingest/formats.rs`; real files in `tests/ingest/recordings` (its
//!    `README.md` says how each was made). A target in `tests/fuzz/targets` with `seeds/<format>` and
//!    `dictionaries/<format>.dict`, its name in `tests/fuzz/Cargo.toml` and twice in `tests/fuzz/run`.
//!    `cargo test --test ingest`, `cargo test --lib -- ingest::`.
//! 4. `src/http/handlers/maneuvers.rs`: media types, and what the upload and `AnyFile` say; then
//!    `cargo run -- openapi > openapi/trimtab.json`. Its ending in `accept` in `src/dashboard/maneuvers_page.rs`, its name in
//!    the help of `src/cli/request.rs`; the table of formats in `src/guide/recordings.md`.
//!
//! **Add the layout of a logger.**
//! 1. `tests/common/layouts.rs`: a small file of your own making in it. Most go in as they are.
//! 2. Where names or units are missing: `src/core/ingest/mapping/<name>.toml`, and a row of `BUNDLED` beside it; `recognise` has the
//!    titles by which it is used without being named. The list in `src/guide/recordings.md`.
//!
//! **Add an endpoint.**
//! 1. `src/http/handlers/<resource>.rs`: the handler under `#[utoipa::path]`, and `router()`; `coefficients.rs` is a small
//!    one. It asks the store or the core, on `service.compute` where that takes long; what is refused is a `Problem` with
//!    a `Code`.
//! 2. `src/http/handlers/mod.rs`: its router. `src/http/caller.rs`: the scope that a key needs for it, if not the usual.
//! 3. A test against the real server in `tests/service`.
//! 4. `cargo run -- openapi > openapi/trimtab.json`: a test compares.
//!
//! **Add a page.**
//! 1. `src/dashboard/<name>_page.rs`: a view, a struct of all that is shown, and a function from it to the page
//!    (`layout::page`); both in `pub use` of `src/dashboard/mod.rs`. A script of its own is a file of `assets` and a line in
//!    `assets.rs`. If it can be reached from every page: a line of `WAYS` in `layout.rs`.
//! 2. `src/http/pages/<name>.rs`: the route, and the view made of what the store has; merged in `mod.rs` beside it.
//!    `new_job.rs` is the smallest, `models.rs` one with a view. What is only read needs no line in `caller.rs`.
//! 3. `tests/service/pages`: what it shows, in the file of its subject; its address in the list of `browser.rs`, which looks at
//!    every page for accessibility and overflow. `tests/browser cargo test --test service pages::`.
//! 4. Its line in the list of pages in `src/guide/pages.md`.
//!
//! **Add a page of the guide.**
//! 1. `src/guide/<name>.md`: Markdown that a forge shows, too; links go to files (`findings.md#gap`). Blocks of `sh`, `python`, `json`,
//!    `toml` and `toml model` are run or read by tests, those of `text` and `sh server` are only shown.
//! 2. `src/dashboard/guide.rs`: its line in `TEXTS`.
//! 3. Pages that are made from the code (`effects`, `problems`, `commands`, `confusion`) are written anew by
//!    `TRIMTAB_WRITE_GUIDE=1 cargo test --test service guide::`, and what shows them is built after that.

pub use trimtab_core::{
    design, diagnose, dynamics, estimate, flight, ingest, job, model, recursive, response,
    simulate, stop, structure,
};

pub mod cli;
pub mod dashboard;
pub mod http;
pub mod store;
pub mod webhook;
pub mod work;
