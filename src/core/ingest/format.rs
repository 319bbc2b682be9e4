//! What a recording is written in, as its sender says it.

/// What a recording is written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// A table of text, a row for each sample.
    Csv,
    /// One time axis and a list of values for each channel.
    Json,
    /// A MAT file of version 4 or 5.
    Mat,
    /// A matrix of numbers as text, or any other table of text.
    Ascii,
    /// Not said: the first bytes tell what it is, and text that is not JSON is a table or a matrix.
    Unstated,
}

impl Format {
    /// The media types of [`Format::from_content_type`], for a message that says what is accepted.
    pub const CONTENT_TYPES: [&str; 5] = [
        "text/csv",
        "application/json",
        "application/x-matlab-data",
        "text/plain",
        "application/octet-stream",
    ];

    /// The media type of an upload.
    pub fn content_type(self) -> &'static str {
        match self {
            Self::Csv => "text/csv",
            Self::Json => "application/json",
            Self::Mat => "application/x-matlab-data",
            Self::Ascii => "text/plain",
            Self::Unstated => "application/octet-stream",
        }
    }

    /// By the end of a file's name, without the dot; `None` if it says nothing.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "json" => Some(Self::Json),
            "mat" => Some(Self::Mat),
            "asc" => Some(Self::Ascii),
            "gz" | "zip" | "xlsx" | "xlsm" | "ulg" | "ulog" | "bin" | "parquet" | "pq" | "h5"
            | "hdf5" | "hdf" | "tdms" | "mf4" => Some(Self::Unstated),
            _ => None,
        }
    }

    /// The charset that a `Content-Type` says.
    pub fn charset(content_type: &str) -> Option<&str> {
        let mut parameters = content_type.split(';').skip(1);
        parameters.find_map(|parameter| {
            let (name, value) = parameter.split_once('=')?;
            let is_charset = name.trim().eq_ignore_ascii_case("charset");
            is_charset.then(|| value.trim().trim_matches('"'))
        })
    }

    /// Reads a `Content-Type`; its parameters (`charset=...`) are ignored.
    pub fn from_content_type(content_type: &str) -> Option<Self> {
        let essence = content_type.split(';').next().unwrap_or_default().trim();
        match essence.to_ascii_lowercase().as_str() {
            "text/csv" | "application/csv" => Some(Self::Csv),
            "application/json" | "text/json" => Some(Self::Json),
            "application/x-matlab-data" | "application/matlab-mat" => Some(Self::Mat),
            "text/plain" => Some(Self::Ascii),
            "application/octet-stream"
            | "application/gzip"
            | "application/x-gzip"
            | "application/zip"
            | "application/x-zip-compressed"
            | "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
            | "application/vnd.ms-excel.sheet.macroenabled.12"
            | "application/vnd.apache.parquet"
            | "application/x-hdf5"
            | "application/x-hdf" => Some(Self::Unstated),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_types_are_read_without_their_parameters() {
        let format = Format::from_content_type;
        assert_eq!(format("text/csv; charset=utf-8"), Some(Format::Csv));
        assert_eq!(format("Application/JSON"), Some(Format::Json));
        assert_eq!(format("application/pdf"), None);
        assert_eq!(format("application/gzip"), Some(Format::Unstated));
        assert_eq!(format(""), None);
        for accepted in Format::CONTENT_TYPES {
            assert_eq!(format(accepted).map(Format::content_type), Some(accepted));
        }
    }

    #[test]
    fn endings_of_files_are_known_in_any_case() {
        for extension in ["csv", "JSON", "mat", "asc", "gz", "xlsx", "ulg", "bin"] {
            assert!(Format::from_extension(extension).is_some());
        }
        assert_eq!(Format::from_extension("txt"), None);
    }
}
