//! `trimtab audit`: who did what cannot be undone, or lets somebody in.

use clap::Args;
use comfy_table::Table;
use comfy_table::presets::NOTHING;

use super::Failure;
use super::process::Database;

/// Show who deleted what, and who made, replaced and revoked keys and webhooks; newest first.
#[derive(Args)]
pub(super) struct Audit {
    #[command(flatten)]
    database: Database,
    /// Of one project only, and of all at once.
    #[arg(long)]
    project: Option<String>,
    /// How many lines.
    #[arg(long, default_value_t = 100, value_name = "N")]
    limit: usize,
}

impl Audit {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let store = self.database.open().await?;
        let mut table = Table::new();
        table.load_style(NOTHING);
        table.set_header(["at", "project", "key", "deed", "subject"]);
        let page = store
            .audit(self.project.as_deref(), None, self.limit)
            .await?;
        for line in page.map(|page| page.entries).unwrap_or_default() {
            let project = match line.project.as_str() {
                "" => "all".to_string(),
                project => project.to_string(),
            };
            let key = line.key.unwrap_or_default();
            table.add_row([line.at, project, key, line.deed, line.subject]);
        }
        println!("{table}");
        store.close().await;
        Ok(())
    }
}
