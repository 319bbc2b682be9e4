//! Tables in a file: frames of pandas, and datasets whose elements have fields.

use super::super::columns::{Cells, Column, Columns, NONE, Texts};
use super::super::{Limits, text::quoted};
use super::attribute::{self, trimmed};
use super::damage::damaged;
use super::dataset::Dataset;
use super::datatype::Type;
use super::file::File;
use super::objects::Object;
use super::pickle::pickled;
use super::room;
use crate::flight::Fault;

/// What a table consists of.
enum Kind {
    /// A frame of pandas, as `to_hdf` writes it unless another format is asked for.
    Fixed,
    /// The same with `format="table"`.
    Appendable,
    /// A dataset of one dimension whose elements have fields.
    Plain,
}

/// The only table of a file; `None` where there is none, or several.
///
/// # Errors
/// It is damaged, or has more in it than the limits allow.
pub(super) fn only(
    file: &File,
    objects: &[Object],
    limits: &Limits,
) -> Result<Option<Columns>, Fault> {
    let mut tables = objects
        .iter()
        .filter_map(|object| Some((object, kind(file, object)?)));
    let (Some((object, kind)), None) = (tables.next(), tables.next()) else {
        return Ok(None);
    };
    let mut reading = Reading {
        file,
        limits,
        room: room::of(limits),
        columns: Columns::default(),
    };
    match kind {
        Kind::Fixed => reading.fixed(object, objects)?,
        Kind::Appendable => {
            let dataset = member(objects, object, "table");
            let dataset = dataset.ok_or_else(|| damaged("a frame of pandas has no table"))?;
            reading.fields(dataset)?;
        }
        Kind::Plain => reading.fields(object)?,
    }
    Ok(Some(reading.columns))
}

fn kind(file: &File, object: &Object) -> Option<Kind> {
    if let Some(dataset) = &object.dataset {
        let is_table = matches!(dataset.kind, Type::Compound(..)) && dataset.dimensions.len() == 1;
        // that of a frame counts with its group, and a complex number of MATLAB is none
        let is_of_frame = attribute::is_there(file, &object.header, "index_kind");
        return (is_table && !is_of_frame && object.class.is_none()).then_some(Kind::Plain);
    }
    match attribute::text(file, &object.header, "pandas_type")?.as_str() {
        "frame" => Some(Kind::Fixed),
        "frame_table" => Some(Kind::Appendable),
        _ => None,
    }
}

/// What is in a group under a name.
fn member<'o, 'a>(objects: &'o [Object<'a>], group: &Object, name: &str) -> Option<&'o Object<'a>> {
    objects.iter().find(|object| {
        let within = object.path.strip_prefix(&group.path[..]);
        within.is_some_and(|within| within == [name])
    })
}

struct Reading<'r, 'a> {
    file: &'r File<'a>,
    limits: &'r Limits,
    room: usize,
    columns: Columns,
}

/// Blocks of a frame: one for each kind of number, as a rule.
const MOST_BLOCKS: usize = 100;

impl<'a> Reading<'_, 'a> {
    fn fixed(&mut self, frame: &Object, objects: &[Object<'a>]) -> Result<(), Fault> {
        let Some(index) = member(objects, frame, "axis1") else {
            return Err(damaged("a frame of pandas has no index"));
        };
        let kind = attribute::text(self.file, &index.header, "kind").unwrap_or_default();
        let name = attribute::text(self.file, &index.header, "name").unwrap_or_default();
        let title = name_of_index(&name);
        let Some(dataset) = &index.dataset else {
            return Err(damaged("the index of a frame of pandas is none"));
        };
        self.columns.rows = dataset.count().unwrap_or(usize::MAX);
        self.check(1)?;
        self.add(title, dataset, &kind)?;
        for at in 0..MOST_BLOCKS {
            let part = |name: &str| {
                let found = member(objects, frame, &format!("block{at}_{name}"))?;
                Some((found, found.dataset.as_ref()?))
            };
            let Some(((_, items), (object, values))) = part("items").zip(part("values")) else {
                break;
            };
            let titles = self.texts(items)?;
            let kind = attribute::text(self.file, &object.header, "value_type");
            self.block(titles, values, &kind.unwrap_or_default())?;
        }
        Ok(())
    }

    /// Columns beside each other in one dataset; `kind` is what pandas says of them.
    fn block(
        &mut self,
        titles: Vec<String>,
        values: &Dataset<'a>,
        kind: &str,
    ) -> Result<(), Fault> {
        self.check(self.columns.list.len() + titles.len())?;
        let Some(number) = values.kind.number() else {
            let why = format!("it holds {}, not numbers", values.kind.name());
            let left_out = titles.into_iter().map(|title| (title, why.clone()));
            self.columns.left_out.extend(left_out);
            return Ok(());
        };
        let shape = [self.columns.rows as u64, titles.len() as u64];
        if values.dimensions != shape {
            return Err(damaged(
                "a block of a frame of pandas has another shape than its titles",
            ));
        }
        let bytes = values.bytes(self.file, &mut self.room)?;
        let row = number.width * titles.len();
        for (at, title) in titles.into_iter().enumerate() {
            let from = at * number.width;
            if is_of_time(kind) {
                let cells = bytes.chunks_exact(row);
                let cells = cells.map(|row| row.get(from..from + number.width).unwrap_or_default());
                self.cells(title, &values.kind, cells, kind);
                continue;
            }
            let cells = bytes.chunks_exact(row);
            let cells = cells.map(|row| {
                row.get(from..from + number.width)
                    .map_or(f64::NAN, number.read)
            });
            let cells = Cells::Doubles(cells.collect());
            self.push(title, "", cells);
        }
        Ok(())
    }

    /// The fields of a dataset, each a column, or several.
    fn fields(&mut self, object: &Object<'a>) -> Result<(), Fault> {
        let Some(dataset) = &object.dataset else {
            return Err(damaged("a table is none"));
        };
        let Type::Compound(fields, width) = &dataset.kind else {
            return Err(damaged("a table has no fields"));
        };
        let text =
            |name: &str| attribute::text(self.file, &object.header, name).unwrap_or_default();
        // the titles of what pandas puts into one field, and what its index or the field is
        let described: Vec<(Vec<String>, String)> = fields
            .iter()
            .map(|field| {
                let titles = format!("{}_kind", field.name);
                let titles = attribute::bytes(self.file, &object.header, &titles);
                let titles = pickled(titles.unwrap_or_default());
                let kind = match field.name == "index" {
                    true => text("index_kind"),
                    false => text(&format!("{}_dtype", field.name)),
                };
                (titles, kind)
            })
            .collect();
        self.columns.rows = dataset.count().unwrap_or(usize::MAX);
        let columns = fields.iter().map(|field| match &field.kind {
            Type::Array(_, count) => *count,
            _ => 1,
        });
        self.check(columns.fold(0, usize::saturating_add))?;
        let bytes = dataset.bytes(self.file, &mut self.room)?;
        for (field, (titles, kind)) in fields.iter().zip(described) {
            let (of, count) = match &field.kind {
                Type::Array(of, count) => (of.as_ref(), *count),
                of => (of, 1),
            };
            for at in 0..count {
                let title = match titles.get(at) {
                    Some(title) => title.clone(),
                    None if count == 1 => field.name.clone(),
                    None => format!("{}[{at}]", field.name),
                };
                let from = field.at + at * of.width();
                let values = bytes.chunks_exact(*width);
                let values = values.map(|row| row.get(from..from + of.width()).unwrap_or_default());
                self.cells(title, of, values, &kind);
            }
        }
        Ok(())
    }

    fn add(&mut self, title: String, dataset: &Dataset<'a>, kind: &str) -> Result<(), Fault> {
        let bytes = dataset.bytes(self.file, &mut self.room)?;
        let values = bytes.chunks_exact(dataset.kind.width().max(1));
        self.cells(title, &dataset.kind, values, kind);
        Ok(())
    }

    /// Adds a column of stored values; `kind` is what pandas says of them.
    fn cells<'v>(
        &mut self,
        title: String,
        of: &Type,
        values: impl Iterator<Item = &'v [u8]>,
        kind: &str,
    ) {
        let kind = without_zone(kind);
        let is_known = instants(&kind).is_some() || !duration(&kind).is_empty();
        if is_of_time(&kind) && !(is_known && matches!(of, Type::Long)) {
            let why = format!("it is of {}, which is not read", quoted(&kind));
            self.columns.left_out.push((title, why));
            return;
        }
        let long = |bytes: &[u8]| bytes.try_into().map_or(NONE, i64::from_le_bytes);
        match of {
            Type::Long => {
                let longs = values.map(long);
                let (cells, unit) = match instants(&kind) {
                    Some(each) => {
                        let longs = longs.map(|value| match value {
                            NONE => NONE,
                            value => value.checked_mul(each).unwrap_or(NONE),
                        });
                        (Cells::Instants(longs.collect()), "")
                    }
                    None => (Cells::Integers(longs.collect()), duration(&kind)),
                };
                self.push(title, unit, cells);
            }
            Type::Number(number) => {
                let cells = Cells::Doubles(values.map(number.read).collect());
                self.push(title, "", cells);
            }
            Type::Text(_) => {
                let mut texts = Texts::default();
                values.for_each(|bytes| texts.push(trimmed(bytes).as_bytes()));
                self.push(title, "", Cells::Texts(texts));
            }
            other => {
                let why = format!("it holds {}, not numbers", other.name());
                self.columns.left_out.push((title, why));
            }
        }
    }

    fn push(&mut self, title: String, unit: &'static str, cells: Cells) {
        self.columns.list.push(Column { title, unit, cells });
    }

    fn texts(&mut self, dataset: &Dataset<'a>) -> Result<Vec<String>, Fault> {
        let Type::Text(width) = dataset.kind else {
            let what = quoted(dataset.kind.name());
            return Err(damaged(&format!(
                "the titles of a frame of pandas are {what}"
            )));
        };
        let count = dataset.count().unwrap_or(usize::MAX);
        self.limits.columns(count).map_or(Ok(()), Err)?;
        let bytes = dataset.bytes(self.file, &mut self.room)?;
        Ok(bytes.chunks_exact(width).map(trimmed).collect())
    }

    /// # Errors
    /// There are more columns or rows than the limits allow.
    fn check(&self, columns: usize) -> Result<(), Fault> {
        let rows = self.columns.rows;
        let too_much = [
            self.limits.columns(columns),
            self.limits.samples(rows),
            self.limits.values(rows.saturating_mul(columns)),
        ];
        too_much.into_iter().flatten().next().map_or(Ok(()), Err)
    }
}

/// Whether pandas counts instants or durations.
fn is_of_time(kind: &str) -> bool {
    kind.starts_with("datetime64") || kind.starts_with("timedelta64")
}

/// Instants count from 1970 in Greenwich, whatever zone they are shown in: `datetime64[ns, UTC]`.
fn without_zone(kind: &str) -> String {
    match kind.split_once(',') {
        Some((kind, _)) if is_of_time(kind) => format!("{kind}]"),
        _ => kind.to_string(),
    }
}

/// Nanoseconds of a unit in which pandas counts from 1970.
fn instants(kind: &str) -> Option<i64> {
    match kind {
        "datetime64[s]" => Some(1_000_000_000),
        "datetime64[ms]" => Some(1_000_000),
        "datetime64[us]" => Some(1000),
        "datetime64" | "datetime64[ns]" => Some(1),
        _ => None,
    }
}

/// The unit of durations of pandas; empty where they are none.
fn duration(kind: &str) -> &'static str {
    match kind {
        "timedelta64[s]" => "s",
        "timedelta64[ms]" => "ms",
        "timedelta64[us]" => "us",
        "timedelta64" | "timedelta64[ns]" => "ns",
        _ => "",
    }
}

/// What an index is called: a text, or something that Python pickled, which is nothing as a rule.
fn name_of_index(name: &str) -> String {
    let is_plain = !name.is_empty() && !name.ends_with('.');
    let name = match is_plain {
        true => Some(name.to_string()),
        false => pickled(name.as_bytes()).into_iter().next(),
    };
    name.unwrap_or_else(|| "index".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_no_counts() {
        let bytes = super::super::file::SIGNATURE.to_vec();
        let bytes = [&bytes[..], &[2, 8, 8, 0], &[0; 36]].concat();
        let file = File::of(&bytes).unwrap();
        let limits = Limits::default();
        let mut reading = Reading {
            file: &file,
            limits: &limits,
            room: 0,
            columns: Columns::default(),
        };
        let counts = [7i64.to_le_bytes(), i64::MIN.to_le_bytes()];
        let mut add = |kind: &str| {
            let values = counts.iter().map(|count| &count[..]);
            reading.cells(kind.to_string(), &Type::Long, values, kind);
        };
        add("datetime64[us, UTC]");
        add("timedelta64[ms]");
        add("int64");
        add("datetime64[D]");
        let columns = &reading.columns;
        let instants = Cells::Instants(vec![7000, NONE]);
        assert!(matches!((&columns.list[0].cells, &instants),
            (Cells::Instants(one), Cells::Instants(other)) if one == other));
        assert_eq!(columns.list[1].unit, "ms");
        assert_eq!(columns.list[2].unit, "");
        assert_eq!(columns.list.len(), 3);
        assert_eq!(columns.left_out[0].0, "datetime64[D]");
    }
}
