//! All that is in a file, by its path.

use super::super::Limits;
use super::attribute;
use super::dataset::Dataset;
use super::file::File;
use super::group;
use super::header::{self, Header};
use crate::flight::Fault;

/// A dataset or a group.
pub(super) struct Object<'a> {
    /// The names on the way to it.
    pub(super) path: Vec<String>,
    pub(super) header: Header<'a>,
    /// `None`: it is a group.
    pub(super) dataset: Option<Dataset<'a>>,
    /// What MATLAB calls it, where MATLAB wrote it.
    pub(super) class: Option<String>,
}

/// Groups in groups; a source has no more names.
const DEEPEST: usize = 8;
/// Groups with what MATLAB and PyTables need for themselves.
const INTERNAL: [&str; 3] = ["#refs#", "#subsystem#", "_i_table"];

/// Looks at the header of everything.
///
/// # Errors
/// The file is damaged, or has more in it than the limit of columns.
pub(super) fn all<'a>(file: &File<'a>, limits: &Limits) -> Result<Vec<Object<'a>>, Fault> {
    let mut room = header::room(file);
    let root = Object {
        path: Vec::new(),
        header: Header::read(file, file.root, &mut room)?,
        dataset: None,
        class: None,
    };
    let mut objects = vec![root];
    let mut at = 0;
    while let Some(object) = objects.get(at) {
        at += 1;
        if object.dataset.is_some() || object.path.len() == DEEPEST {
            continue;
        }
        let path = object.path.clone();
        let members = group::members(file, &object.header, limits.max_columns)?;
        for (name, address) in members {
            if INTERNAL.contains(&name.as_str()) {
                continue;
            }
            let header = Header::read(file, address, &mut room)?;
            let mut path = path.clone();
            path.push(super::super::text::short_message(&name));
            objects.push(Object {
                path,
                dataset: Dataset::read(file, &header)?,
                class: attribute::text(file, &header, "MATLAB_class"),
                header,
            });
            limits.columns(objects.len()).map_or(Ok(()), Err)?;
        }
    }
    Ok(objects)
}

impl Object<'_> {
    pub(super) fn name(&self) -> String {
        self.path.join("/")
    }

    /// For a message.
    pub(super) fn description(&self) -> String {
        let Some(dataset) = &self.dataset else {
            return "a group".to_string();
        };
        let mut sizes: Vec<String> = dataset.dimensions.iter().map(u64::to_string).collect();
        if self.class.is_some() {
            sizes.reverse();
        }
        let what = self.class.as_deref().unwrap_or(dataset.kind.name());
        match sizes.is_empty() {
            true => format!("one of {what}"),
            false => format!("{} {what}", sizes.join("x")),
        }
    }
}
