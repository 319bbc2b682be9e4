//! What all figures have that the drawing library makes: a white sheet, axes, a quiet grid.

use std::fmt::Display;

use plotters::chart::MeshStyle;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub(super) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Room around the axes, in pixels.
pub(super) struct Margins {
    pub around: i32,
    /// For the labels below and on the left.
    pub below: u32,
    pub left: u32,
}

/// A picture as SVG.
pub(super) fn svg(
    size: (u32, u32),
    draw: impl FnOnce(&Area<'_>) -> Result<(), String>,
) -> Result<String, String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(in_words)?;
        draw(&area)?;
        area.present().map_err(in_words)?;
    }
    Ok(svg)
}

pub(super) fn axes<'a, 'b>(
    area: &'a Area<'b>,
    x: (f64, f64),
    y: (f64, f64),
    margins: &Margins,
) -> Result<Chart<'a, 'b>, String> {
    ChartBuilder::on(area)
        .margin(margins.around)
        .margin_right(24)
        .x_label_area_size(margins.below)
        .y_label_area_size(margins.left)
        .build_cartesian_2d(x.0..x.1, y.0..y.1)
        .map_err(in_words)
}

/// Lines at the labels only, so faint that curves stand out.
pub(super) fn faint<DB: DrawingBackend>(
    grid: &mut MeshStyle<'_, '_, RangedCoordf64, RangedCoordf64, DB>,
) {
    grid.light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12));
}

/// The least and the greatest value; `None` if there is none.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    (low <= high).then_some((low, high))
}

/// What the drawing library says.
pub(super) fn in_words(error: impl Display) -> String {
    error.to_string()
}
