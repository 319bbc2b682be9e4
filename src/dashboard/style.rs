//! The look of all pages: light and dark, as the reader's system has it, and fit for printing.

/// Measured and model must be told apart by colour-blind readers and in print: blue dots, orange line
/// (Okabe and Ito).
pub(super) const MEASURED: plotters::style::RGBColor = plotters::style::RGBColor(0, 114, 178);
pub(super) const MODEL: plotters::style::RGBColor = plotters::style::RGBColor(213, 94, 0);

/// The model before its effects were found: grey, behind.
pub(super) const DECLARED: plotters::style::RGBColor = plotters::style::RGBColor(150, 150, 150);

pub(super) const CSS: &str = "
:root { color-scheme: light dark; --line: #8884; --soft: #777; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: 0; } h2 { font-size: 1.15rem; margin-top: 2rem; }
p.soft, td.soft { color: var(--soft); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .8rem .2rem 0; text-align: left; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; }
figure { margin: 1rem 0; background: #fff; border-radius: 6px; padding: .5rem; overflow-x: auto; }
figure svg { width: 100%; height: auto; }
.scroll { overflow-x: auto; }
ul.links { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: 1rem; }
@media print { body { margin: 0; max-width: none; } figure { break-inside: avoid; } }
";
