//! A log as a mapping sees it: tables by name, columns by field, each table with its own time.

use std::collections::BTreeSet;

use super::super::mapping::{Archive, Mapping, OwnTime};
use super::super::matrix::Matrix;
use super::super::reading::Reading;
use super::super::text::{listed, quoted, short_message};
use super::super::{IngestError, Limits, code, fault::of_file, note};
use super::table::Table;
use crate::flight::{Finding, FindingCode};

/// The tables of a log.
pub(in super::super) struct Log<'a> {
    bytes: &'a [u8],
    tables: Vec<Table>,
    /// What was asked for last, row by row.
    values: Vec<f64>,
    /// The titles of the tables that were asked for.
    used: BTreeSet<String>,
    limits: Limits,
}

/// Tables, and fields of one, are listed up to this many.
const LISTED: usize = 60;

impl<'a> Log<'a> {
    /// Of tables, of which messages out of order are left out; those without any message are left out.
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
            used: BTreeSet::new(),
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
            let mut reading = mapping.apply(&mut self, &limits)?;
            reading.findings.extend(self.left_out());
            return Ok(reading);
        }
        let usual = Mapping::named_or_json(usual)?;
        match usual.apply(&mut self, &limits) {
            Err(error) if error.faults()[0].code == code::NO_CHANNELS => {}
            Err(error) => return Err(error),
            Ok(mut reading) => {
                // no log has everything that is usual
                let absent = FindingCode::Absent.name();
                reading.findings.retain(|finding| finding.code != absent);
                reading.findings.extend(self.left_out());
                return Ok(reading);
            }
        }
        let message = format!(
            "the log has nothing of what its usual mapping takes; say with a mapping which fields are wanted, as {{\"channels\": {{\"q\": {{\"from\": \"IMU.GyrY\", \"unit\": \"rad/s\"}}}}}}. It has {}",
            self.contents()
        );
        Err(of_file(code::MAPPING_NEEDED, message).into())
    }

    /// What was left out of the tables that were asked for.
    fn left_out(&self) -> impl Iterator<Item = Finding> {
        let told = |code, count: fn(&Table) -> usize, why, remedy| {
            let is_told = |table: &&Table| count(table) > 0 && self.used.contains(&table.title());
            let tables: Vec<&Table> = self.tables.iter().filter(is_told).collect();
            let counts = tables.iter();
            let counts = counts.map(|table| format!("{} of {}", count(table), table.title()));
            let message = format!("messages were left out, {}: {why}", note::listed(counts));
            let finding = Finding {
                count: tables.iter().map(|table| count(table)).sum(),
                ..note::note(code, message, remedy)
            };
            (!tables.is_empty()).then_some(finding)
        };
        let repeated = told(
            FindingCode::RepeatedTime,
            |table| table.repeated,
            "another has the same time",
            "nothing needs to be done where they are the same messages again",
        );
        let late = told(
            FindingCode::OutOfOrder,
            |table| table.late,
            "their times are not in order with those of the others",
            "a few are damaged times; many mean that the clock was set: cut the log there, and upload its parts one by one",
        );
        repeated.into_iter().chain(late)
    }

    fn contents(&self) -> String {
        let titles = self.tables.iter().map(Table::title);
        listed(titles, LISTED)
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
            let all = listed(table.fields.iter().map(of_field), LISTED);
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
        let title = table.title();
        self.used.insert(title);
        self.values = values;
        Ok(Matrix::of_rows(&self.values, fields.len()))
    }

    fn unit(&self, path: &[String]) -> Option<String> {
        let table = self.find(path).ok()?;
        let name = path.get(1..).unwrap_or_default().join(".");
        let field = table.fields.get(*table.find(&name).first()?)?;
        Some(field.unit.clone()).filter(|unit| !unit.is_empty())
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
