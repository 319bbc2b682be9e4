//! A log as a mapping sees it: tables by name, columns by field, each table with its own time.

use super::super::mapping::{Archive, Mapping, OwnTime};
use super::super::matrix::Matrix;
use super::super::reading::Reading;
use super::super::text::{quoted, short_message};
use super::super::{IngestError, Limits, code, fault::of_file};
use super::table::Table;

/// The tables of a log.
pub(in super::super) struct Log<'a> {
    bytes: &'a [u8],
    tables: Vec<Table>,
    /// What was asked for last, row by row.
    values: Vec<f64>,
    limits: Limits,
}

/// Tables, and fields of one, are listed up to this many.
const LISTED: usize = 60;

impl<'a> Log<'a> {
    /// Of tables without messages out of order; those without any message are left out.
    pub(in super::super) fn of(bytes: &'a [u8], mut tables: Vec<Table>, limits: &Limits) -> Self {
        for table in &mut tables {
            table.in_order(bytes);
        }
        tables.retain(|table| !table.rows.is_empty());
        tables.sort_by(|a, b| (&a.name, a.instance).cmp(&(&b.name, b.instance)));
        Self {
            bytes,
            tables,
            values: Vec::new(),
            limits: *limits,
        }
    }

    /// What a mapping makes of it; where there is none, what `usual` does, as far as the log has it.
    ///
    /// # Errors
    /// What the mapping names is not there; or there is nothing of the usual.
    pub(in super::super) fn read(
        mut self,
        mapping: Option<&Mapping>,
        usual: &str,
    ) -> Result<Reading, IngestError> {
        let limits = self.limits;
        if let Some(mapping) = mapping {
            return mapping.apply(&mut self, &limits);
        }
        let usual = Mapping::named_or_json(usual)?;
        match usual.apply(&mut self, &limits) {
            Err(error) if error.faults()[0].code == code::NO_CHANNELS => {}
            Err(error) => return Err(error),
            // no log has everything that is usual
            Ok(reading) => return Ok(reading.maneuver.into()),
        }
        let message = format!(
            "the log has nothing of what its usual mapping takes; say with a mapping which fields are wanted, as {{\"channels\": {{\"q\": {{\"from\": \"IMU.GyrY\", \"unit\": \"rad/s\"}}}}}}. It has {}",
            self.contents()
        );
        Err(of_file(code::MAPPING_NEEDED, message).into())
    }

    fn contents(&self) -> String {
        let titles = self.tables.iter().map(Table::title);
        listed(titles)
    }

    fn find(&self, path: &[String]) -> Result<&Table, String> {
        let name = path.first().map_or("", String::as_str);
        // one of this very name goes before an instance of another
        let exact = self.tables.iter().find(|table| table.title() == name);
        let table = exact.or_else(|| self.tables.iter().find(|table| table.is_called(name)));
        table.ok_or_else(|| {
            let near = self.tables.iter().map(Table::title).min_by_key(|title| {
                strsim::damerau_levenshtein(&title.to_lowercase(), &name.to_lowercase())
            });
            let near = near.map_or(String::new(), |near| format!("; {} is near", quoted(&near)));
            format!(
                "the log has no messages {}{near}; it has {}",
                quoted(name),
                self.contents()
            )
        })
    }
}

fn listed(mut names: impl Iterator<Item = String>) -> String {
    let mut list: Vec<String> = names.by_ref().take(LISTED).collect();
    if list.is_empty() {
        return "no messages".to_string();
    }
    match names.count() {
        0 => {}
        more => list.push(format!("and {more} more")),
    }
    list.join(", ")
}

impl Archive for Log<'_> {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let unknown = |why: String| (code::UNKNOWN_SOURCE, why);
        let table = self.find(path).map_err(unknown)?;
        let name = path.get(1..).unwrap_or_default().join(".");
        let fields = table.find(&name);
        if fields.is_empty() {
            let of_field = |field: &super::table::Field| match field.unit.as_str() {
                "" => field.name.clone(),
                unit => format!("{} [{unit}]", field.name),
            };
            let all = listed(table.fields.iter().map(of_field));
            return Err(unknown(format!(
                "{} has no field {}; it has {}",
                table.title(),
                quoted(&name),
                short_message(&all)
            )));
        }
        let bytes = self.bytes;
        let count = table.rows.len().saturating_mul(fields.len());
        if let Some(fault) = self.limits.values(count) {
            return Err((code::TOO_MANY_VALUES, fault.message));
        }
        let mut values = Vec::with_capacity(count);
        for &row in &table.rows {
            let of_row = fields.iter().map(|&at| table.fields[at].value(bytes, row));
            values.extend(of_row);
        }
        self.values = values;
        Ok(Matrix::of_rows(&self.values, fields.len()))
    }

    fn own_time(&self, path: &[String]) -> Option<OwnTime> {
        let table = self.find(path).ok()?;
        let field = &table.fields[table.time];
        Some(OwnTime {
            path: vec![table.title(), field.name.clone()],
            unit: table.time_unit,
        })
    }
}
