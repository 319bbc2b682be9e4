//! What a mapping needs of a file.

use super::super::matrix::Matrix;

/// A file that values are taken from by name.
pub(in super::super) trait Archive {
    /// The matrix at a path; an empty path is the only matrix of the file.
    ///
    /// # Errors
    /// A code and a message: there is none, with what there is instead; or it cannot be read.
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)>;

    /// The unit that the file itself says of what is at a path; `None` where it says none.
    fn unit(&self, _path: &[String]) -> Option<String> {
        None
    }

    /// The time of the table that a path leads into, where the file itself says which it is.
    fn own_time(&self, _path: &[String]) -> Option<OwnTime> {
        None
    }
}

/// Where the times of a table are.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(in super::super) struct OwnTime {
    pub(in super::super) path: Vec<String>,
    pub(in super::super) unit: &'static str,
}
