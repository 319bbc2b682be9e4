//! The messages of one kind: where each stands in the file, and what its fields are.

use std::rc::Rc;

use super::super::stored::Stored;
use super::order::longest_in_order;

/// A number of a message.
#[derive(Clone, Debug)]
pub(in super::super) struct Field {
    /// As `xyz[0]`, counted from 0, where it is one of an array.
    pub(in super::super) name: String,
    /// Where it stands in the message.
    pub(in super::super) at: usize,
    pub(in super::super) number: Stored,
    /// As the log says it; empty where it does not.
    pub(in super::super) unit: String,
}

/// The fields of a kind of message, which several tables may share.
pub(in super::super) type Fields = Rc<Vec<Field>>;

/// Where in the file a message begins.
pub(in super::super) type Row = u32;

/// The messages of one kind and one instance, in the order of the file.
#[derive(Clone, Debug)]
pub(in super::super) struct Table {
    pub(in super::super) name: String,
    /// Which of several sensors or estimators of one kind, from 0; `None` where the log does not number them.
    pub(in super::super) instance: Option<u32>,
    pub(in super::super) fields: Fields,
    /// Which field is time.
    pub(in super::super) time: usize,
    pub(in super::super) time_unit: &'static str,
    pub(in super::super) rows: Vec<Row>,
    /// Messages that were left out: of a time that another has, and of one that does not fit between the others.
    pub(in super::super) repeated: usize,
    pub(in super::super) late: usize,
}

impl Table {
    /// Leaves out messages whose times are none, or not in order.
    pub(super) fn in_order(&mut self, bytes: &[u8]) {
        let field = self.fields[self.time].clone();
        let time = |row: Row| field.value(bytes, row);
        let count = self.rows.len();
        self.rows.retain(|&row| time(row).is_finite());
        let kept = match self.rows.is_sorted_by(|&a, &b| time(a) < time(b)) {
            true => std::mem::take(&mut self.rows),
            false => longest_in_order(&self.rows, time),
        };
        let is_known = |row: &&Row| {
            let time_of_row = time(**row);
            kept.binary_search_by(|&row| time(row).total_cmp(&time_of_row))
                .is_ok()
        };
        let again = self.rows.iter().filter(is_known).count();
        self.repeated = again.saturating_sub(kept.len());
        self.late = count - kept.len() - self.repeated;
        self.rows = kept;
    }

    /// As a mapping writes it.
    pub(super) fn title(&self) -> String {
        match self.instance {
            None | Some(0) => self.name.clone(),
            Some(instance) => format!("{}[{instance}]", self.name),
        }
    }

    /// Whether a name in a mapping means this table: `accel`, `accel[0]`, or as `ulog2csv` writes it, `accel_0`.
    pub(super) fn is_called(&self, name: &str) -> bool {
        let Some(rest) = name.strip_prefix(self.name.as_str()) else {
            return false;
        };
        let number = rest
            .strip_prefix('[')
            .and_then(|rest| rest.strip_suffix(']'))
            .or_else(|| rest.strip_prefix('_'));
        let instance = self.instance.unwrap_or(0);
        match number {
            None => rest.is_empty() && instance == 0,
            Some(number) => number.parse() == Ok(instance),
        }
    }

    /// The fields that a name means: one, or all of an array.
    pub(super) fn find(&self, name: &str) -> Vec<usize> {
        let exact = self.fields.iter().position(|field| field.name == name);
        if let Some(at) = exact {
            return vec![at];
        }
        let of_array = |field: &Field| {
            let index = field.name.strip_prefix(name);
            let index = index.and_then(|rest| rest.strip_prefix('['));
            index
                .and_then(|rest| rest.strip_suffix(']'))
                .is_some_and(|index| index.bytes().all(|byte| byte.is_ascii_digit()))
        };
        let fields = self.fields.iter().enumerate();
        fields
            .filter(|(_, field)| of_array(field))
            .map(|(at, _)| at)
            .collect()
    }
}

impl Field {
    /// Its value in the message at `row`; NaN behind the end of the file.
    pub(super) fn value(&self, bytes: &[u8], row: Row) -> f64 {
        let start = row as usize + self.at;
        let value = bytes.get(start..start + self.number.width);
        value.map_or(f64::NAN, self.number.read)
    }
}
