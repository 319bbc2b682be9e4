//! `trimtab models`: the models of a server.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Failure;
use super::client::Client;
use super::form::{Column, Form};
use super::recording::read_text;
use super::server::ServerOption;

/// Lists the models of a server, prints the document of one as TOML, or stores one. (`trimtab model` is the catalog, without a
/// server.)
#[derive(Args, Debug)]
pub(super) struct Models {
    /// A catalog name, or the id of a stored model.
    #[arg(conflicts_with_all = ["add", "search", "limit", "csv"])]
    id: Option<String>,
    #[command(flatten)]
    server: ServerOption,
    /// Store a model document (.toml, .json), and print its id, which a job names as its model.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["search", "limit", "csv", "json"])]
    add: Option<PathBuf>,
    /// Only those that have each of these words in their name or title.
    #[arg(long, value_name = "WORDS")]
    search: Option<String>,
    /// At most so many.
    #[arg(long, default_value_t = 50, value_name = "N")]
    limit: usize,
    #[command(flatten)]
    form: Form,
}

const COLUMNS: [Column; 7] = [
    Column::text("id", "/id"),
    Column::only_in_csv("origin", "/origin"),
    Column::text("name", "/name"),
    Column::text("title", "/title"),
    Column::only_in_csv("inputs", "/inputs"),
    Column::only_in_csv("outputs", "/outputs"),
    Column::only_in_csv("created", "/created"),
];

impl Models {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let client = Client::of(&self.server)?;
        if let Some(file) = &self.add {
            let media_type = media_type(file);
            let stored = client.add_model(media_type, read_text(file)?).await?;
            println!("{}", stored.id);
        } else if let Some(id) = &self.id {
            let format = if self.form.json { "json" } else { "toml" };
            let path = format!("models/{}", super::client::in_path(id));
            let text = client.text(&path, &[("format", format)]).await?;
            if self.form.json {
                let document: serde_json::Value = serde_json::from_str(&text)?;
                println!("{}", serde_json::to_string_pretty(&document)?);
            } else {
                print!("{text}");
            }
        } else {
            let wanted = [("q", self.search.as_deref())];
            let models = client.list("models", &wanted, self.limit).await?;
            self.form.print(&COLUMNS, &models)?;
        }
        Ok(())
    }
}

fn media_type(file: &Path) -> &'static str {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("json") => "application/json",
        _ => "application/toml",
    }
}
