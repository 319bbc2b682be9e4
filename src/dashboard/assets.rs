//! Files that pages load.

use std::sync::LazyLock;

use crate::ingest::bundled::UNDECLARED;

/// A file as it is served.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Asset {
    pub media_type: &'static str,
    pub content: &'static str,
}

/// The style sheet, which a report has inside it.
pub(super) const STYLE: &str = include_str!("assets/style.css");

/// The chart library, out of the package that it comes with.
static PLOTLY: LazyLock<String> = LazyLock::new(|| {
    let page = plotly::Plot::offline_js_sources();
    let at = page.find("plotly.js v").expect("the package holds it");
    let begin = page[..at].rfind("<script").expect("in an element");
    let begin = begin + page[begin..].find('>').expect("with an end") + 1;
    let end = begin + page[begin..].find("</script>").expect("that is closed");
    page[begin..end].to_string()
});

const SCRIPT: &str = "text/javascript";

/// The file of that name under `/assets/`.
pub fn asset(name: &str) -> Option<Asset> {
    let (media_type, content) = match name {
        "style.css" => ("text/css", STYLE),
        "mark.svg" => ("image/svg+xml", include_str!("assets/mark.svg")),
        "plotly.js" => (SCRIPT, PLOTLY.as_str()),
        "examples.js" => (SCRIPT, include_str!("assets/examples.js")),
        "service.js" => (SCRIPT, include_str!("assets/service.js")),
        "new_job.js" => (SCRIPT, include_str!("assets/new_job.js")),
        "faults.js" => (SCRIPT, include_str!("assets/faults.js")),
        "plot.js" => (SCRIPT, include_str!("assets/plot.js")),
        "job.js" => (SCRIPT, include_str!("assets/job.js")),
        "models.js" => (SCRIPT, include_str!("assets/models.js")),
        "export.js" => (SCRIPT, include_str!("assets/export.js")),
        "figures.js" => (SCRIPT, include_str!("assets/figures.js")),
        "compare.js" => (SCRIPT, include_str!("assets/compare.js")),
        "ticked.js" => (SCRIPT, include_str!("assets/ticked.js")),
        "jobs.js" => (SCRIPT, include_str!("assets/jobs.js")),
        "maneuver.js" => (SCRIPT, include_str!("assets/maneuver.js")),
        "maneuvers.js" => (SCRIPT, include_str!("assets/maneuvers.js")),
        "recording.js" => (SCRIPT, include_str!("assets/recording.js")),
        "columns.js" => (SCRIPT, include_str!("assets/columns.js")),
        "upload.js" => (SCRIPT, include_str!("assets/upload.js")),
        _ => ("text/csv", example(name)?),
    };
    Some(Asset {
        media_type,
        content,
    })
}

/// A flight that comes with Trimtab, to try the pages with.
fn example(name: &str) -> Option<&'static str> {
    let name = name.strip_suffix(".csv")?;
    let flight = UNDECLARED.iter().find(|flight| flight.name == name)?;
    Some(flight.csv)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chart_library_comes_alone() {
        let library = asset("plotly.js").expect("it is served").content;
        assert!(library.trim_start().starts_with("/**\n* plotly.js v"));
        assert!(library.contains("newPlot") && !library.contains("MathJax.js"));
        assert!(asset("../Cargo.toml").is_none());
    }
}
