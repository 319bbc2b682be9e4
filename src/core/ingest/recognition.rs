//! What a file is by its first bytes, whatever its name and its sender say.

use crate::flight::Fault;

use super::{code, fault::of_file, hdf5};

/// A format that is known by its first bytes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    Gzip,
    Zip,
    Ulog,
    DataFlash,
    Parquet,
    /// MAT files of version 7.3, too.
    Hdf5,
    Tdms,
    Mdf4,
    /// A MAT file of version 5.
    Mat,
    Foreign(&'static Foreign),
}

/// A format that is not read.
#[derive(PartialEq, Debug)]
pub(super) struct Foreign {
    what: &'static str,
    remedy: &'static str,
    at: usize,
    begins: &'static [u8],
}

impl Foreign {
    pub(super) fn fault(&self) -> Fault {
        Self::named(self.what, self.remedy)
    }

    /// Whether a table of text may begin so, too: `PAR1,PAR2`.
    fn begins_like_text(&self) -> bool {
        self.at == 0 && self.begins.iter().all(u8::is_ascii_alphanumeric)
    }

    /// That a file is of a format that is not read, and what to do about it.
    pub(super) fn named(what: &str, remedy: &str) -> Fault {
        let message = format!("this is {what}, which is not read; {remedy}");
        of_file(code::FORMAT_NOT_READ, message)
    }
}

const fn foreign(
    at: usize,
    begins: &'static [u8],
    what: &'static str,
    remedy: &'static str,
) -> Foreign {
    Foreign {
        what,
        remedy,
        at,
        begins,
    }
}

const UNPACK: &str = "unpack it, or pack it with gzip or zip";
const MDF3: &str =
    "convert it, in Python with asammdf.MDF('file.mdf').convert('4.10').save('file.mf4')";
const ROS: &str = "write the topics as CSV, with rostopic echo -b file.bag -p /topic > topic.csv (ROS 1), or with PlotJuggler";
const NMEA: &str = "write it as CSV, with gpsbabel -i nmea -f file.nmea -o unicsv -F file.csv";
const PICTURE: &str = "send the numbers behind it, as CSV";

/// Where bytes stand, what they are, and what is then to be done. The first that fits counts.
const FOREIGN: &[Foreign] = &[
    foreign(
        0,
        b"PARE",
        "an encrypted Parquet file",
        "write it without encryption, in Python with pyarrow.parquet.write_table(table, 'file.parquet')",
    ),
    foreign(
        0,
        b"\x0e\x03\x13\x01",
        "an HDF 4 file",
        "convert it to HDF5, with h4toh5 file.hdf file.h5",
    ),
    foreign(
        0,
        b"TDSh",
        "the index of a TDMS file (.tdms_index)",
        "send the .tdms file itself",
    ),
    foreign(0, b"MDF     ", "an MDF 3 file", MDF3),
    foreign(0, b"UnFinMF ", "an MDF 3 file that was not finished", MDF3),
    foreign(
        0,
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "a document of the old Office formats (an Excel workbook .xls)",
        "save it as .xlsx or as CSV",
    ),
    foreign(0, b"#ROSBAG", "a ROS bag", ROS),
    foreign(0, b"\x89MCAP0\r\n", "an MCAP file (ROS 2)", ROS),
    foreign(
        0,
        b"SQLite format 3\0",
        "an SQLite database (a ROS 2 bag is one)",
        "write the table as CSV, with sqlite3 -header -csv file.db 'select * from name' > file.csv",
    ),
    foreign(
        0,
        b"H Product:Blackbox",
        "a blackbox log of Betaflight or iNAV",
        "write it as CSV, with blackbox_decode file.bbl or the Blackbox Explorer",
    ),
    foreign(0, b"$GPGGA,", "a log of NMEA sentences", NMEA),
    foreign(0, b"$GPRMC,", "a log of NMEA sentences", NMEA),
    foreign(0, b"$GNGGA,", "a log of NMEA sentences", NMEA),
    foreign(0, b"$GNRMC,", "a log of NMEA sentences", NMEA),
    foreign(
        0,
        b"\x93NUMPY",
        "an array of NumPy (.npy)",
        "write it as text, with numpy.savetxt('file.asc', numpy.load('file.npy'))",
    ),
    foreign(
        0,
        b"ARROW1",
        "an Arrow or Feather file",
        "write it as CSV, in Python with pandas.read_feather('file').to_csv('file.csv', index=False)",
    ),
    foreign(
        0,
        b"FEA1",
        "a Feather file",
        "write it as CSV, in Python with pandas.read_feather('file').to_csv('file.csv', index=False)",
    ),
    foreign(
        0,
        b"CDF\x01",
        "a NetCDF file",
        "write it as CSV, in Python with xarray.open_dataset('file.nc').to_dataframe().to_csv('file.csv')",
    ),
    foreign(
        0,
        b"CDF\x02",
        "a NetCDF file",
        "write it as CSV, in Python with xarray.open_dataset('file.nc').to_dataframe().to_csv('file.csv')",
    ),
    foreign(
        0,
        b"\x25\xeb",
        "an IRIG 106 chapter 10 recording",
        "write the parameters that are wanted as CSV, with your telemetry software or i106lib's tools",
    ),
    foreign(0, b"Obj\x01", "an Avro file", "write it as CSV"),
    foreign(
        0,
        b"ORC",
        "an ORC file",
        "write it as CSV, in Python with pandas.read_orc('file.orc').to_csv('file.csv', index=False)",
    ),
    foreign(0, b"BZh", "a file packed with bzip2", UNPACK),
    foreign(0, b"\xfd7zXZ\0", "a file packed with xz", UNPACK),
    foreign(
        0,
        b"\x28\xb5\x2f\xfd",
        "a file packed with Zstandard",
        UNPACK,
    ),
    foreign(0, b"\x04\x22\x4d\x18", "a file packed with LZ4", UNPACK),
    foreign(0, b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", UNPACK),
    foreign(0, b"Rar!\x1a\x07", "a RAR archive", UNPACK),
    foreign(0, b"MSCF", "a cabinet archive", UNPACK),
    foreign(
        257,
        b"ustar",
        "a tar archive",
        "send the recording in it, alone or packed with gzip or zip",
    ),
    foreign(0, b"%PDF", "a PDF document", PICTURE),
    foreign(0, b"\x89PNG", "a picture (PNG)", PICTURE),
    foreign(0, b"\xff\xd8\xff", "a picture (JPEG)", PICTURE),
    foreign(0, b"GIF8", "a picture (GIF)", PICTURE),
    foreign(0, b"\x7fELF", "a program", PICTURE),
];

/// The first eight bytes are time, the ninth begins a message of MAVLink 1 or 2.
const TELEMETRY: Foreign = foreign(
    8,
    b"",
    "a telemetry log of MAVLink (.tlog)",
    "send the .bin of the flight controller, or write this as CSV, with mavlogdump.py --format csv --types ATTITUDE file.tlog > file.csv",
);

const IGC: Foreign = foreign(
    0,
    b"",
    "a flight of a glider (.igc)",
    "write it as CSV, with gpsbabel -i igc -f file.igc -o unicsv -F file.csv",
);

const IGOR: Foreign = foreign(
    0,
    b"",
    "a text of Igor with waves one behind the other (.itx)",
    "save the waves together, in one block or as general text with their names",
);

const CAN_BUS: Foreign = foreign(
    0,
    b"",
    "a trace of a CAN bus (.asc), whose frames are not decoded",
    "decode it with its .dbc, in Python with asammdf or cantools decode --single-line file.dbc < file.asc, and send the signals as CSV or MDF",
);

impl Kind {
    /// `None` for text, and for what is not known.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let at = |at: usize, begins: &[u8]| {
            let rest = bytes.get(at..);
            rest.is_some_and(|rest| rest.starts_with(begins))
        };
        if at(0, b"\x1f\x8b") {
            return Some(Self::Gzip);
        }
        if at(0, b"PK\x03\x04") || at(0, b"PK\x05\x06") {
            return Some(Self::Zip);
        }
        if at(0, b"ULog\x01\x12\x35") {
            return Some(Self::Ulog);
        }
        if at(0, b"\xa3\x95") {
            return Some(Self::DataFlash);
        }
        if at(0, b"PAR1") && !is_text(bytes) {
            return Some(Self::Parquet);
        }
        if at(0, b"MDF     4") || at(0, b"UnFinMF 4") {
            return Some(Self::Mdf4);
        }
        if at(0, b"TDSm") && !is_text(bytes) {
            return Some(Self::Tdms);
        }
        if hdf5::is_hdf5(bytes) {
            return Some(Self::Hdf5);
        }
        let has_version = at(124, b"\x00\x01IM") || at(124, b"\x01\x00MI");
        if at(0, b"MATLAB 5.0") || at(0, b"MATLAB 7.3") || has_version {
            return Some(Self::Mat);
        }
        let fits = |foreign: &&Foreign| {
            at(foreign.at, foreign.begins) && !(foreign.begins_like_text() && is_text(bytes))
        };
        FOREIGN
            .iter()
            .find(fits)
            .or_else(|| is_telemetry(bytes).then_some(&TELEMETRY))
            .or_else(|| is_of_glider(bytes).then_some(&IGC))
            .or_else(|| is_of_can_bus(bytes).then_some(&CAN_BUS))
            .or_else(|| has_waves_apart(bytes).then_some(&IGOR))
            .map(Self::Foreign)
    }
}

/// Whether there is nothing in the first bytes that no text has.
fn is_text(bytes: &[u8]) -> bool {
    let is_of_text = |byte: &u8| !byte.is_ascii_control() || b"\t\r\n".contains(byte);
    bytes.iter().take(256).all(is_of_text)
}

/// `A`, the maker and the number of a recorder, and then the header of the flight.
fn is_of_glider(bytes: &[u8]) -> bool {
    let first = &bytes[..bytes.len().min(512)];
    let is_maker =
        matches!(first, [b'A', maker @ ..] if maker.iter().take(3).all(u8::is_ascii_alphanumeric));
    is_maker && memchr::memmem::find(first, b"\nHFDTE").is_some()
}

/// `date`, and `base hex` or `base dec` in the line below it.
fn is_of_can_bus(bytes: &[u8]) -> bool {
    let first = &bytes[..bytes.len().min(512)];
    first.starts_with(b"date ") && memchr::memmem::find(first, b"\nbase ").is_some()
}

/// A text of Igor with more than one block.
fn has_waves_apart(bytes: &[u8]) -> bool {
    bytes.starts_with(b"IGOR")
        && memchr::memmem::find_iter(bytes, b"\nWAVES")
            .nth(1)
            .is_some()
}

/// Microseconds since 1970 from 2001 to 2100, and the mark of a message.
fn is_telemetry(bytes: &[u8]) -> bool {
    let Some((time, [0xfd | 0xfe, ..])) = bytes.split_first_chunk() else {
        return false;
    };
    (978_307_200_000_000..4_102_444_800_000_000).contains(&u64::from_be_bytes(*time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_their_first_bytes() {
        let mut hdf5 = vec![0; 512];
        hdf5.extend_from_slice(b"\x89HDF\r\n\x1a\n");
        let mut telemetry = 1_700_000_000_000_000_u64.to_be_bytes().to_vec();
        telemetry.extend_from_slice(b"\xfd\x09");
        let mut tar = vec![b'a'; 257];
        tar.extend_from_slice(b"ustar");
        for (bytes, what) in [
            (&b"PARE\0"[..], "Parquet"),
            (b"TDSh\x0e\0", ".tdms_index"),
            (b"MDF     3.30", "MDF 3"),
            (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", ".xls"),
            (&telemetry, "MAVLink"),
            (&tar, "tar"),
            (b"\x28\xb5\x2f\xfd", "Zstandard"),
        ] {
            let Some(Kind::Foreign(foreign)) = Kind::of(bytes) else {
                panic!("{what} is not known");
            };
            let fault = foreign.fault();
            assert_eq!(fault.code, code::FORMAT_NOT_READ);
            assert!(fault.message.contains(what), "{fault}");
        }
        assert_eq!(Kind::of(b"\x1f\x8b\x08"), Some(Kind::Gzip));
        assert_eq!(Kind::of(b"PK\x03\x04\x14"), Some(Kind::Zip));
        assert_eq!(Kind::of(b"ULog\x01\x12\x35\x01"), Some(Kind::Ulog));
        assert_eq!(Kind::of(b"\xa3\x95\x80\x80"), Some(Kind::DataFlash));
        assert_eq!(Kind::of(b"TDSm\x0e\0"), Some(Kind::Tdms));
        assert_eq!(Kind::of(b"MDF     4.10"), Some(Kind::Mdf4));
        assert_eq!(Kind::of(&hdf5), Some(Kind::Hdf5));
        assert_eq!(Kind::of(b"PAR1\x15\x04"), Some(Kind::Parquet));
        assert_eq!(Kind::of(b"MATLAB 5.0 MAT-file"), Some(Kind::Mat));
    }

    #[test]
    fn text_is_not_taken_for_anything() {
        for text in [
            &b""[..],
            b"P",
            b"time,alpha\n",
            b"{\"time\": 1}",
            b"\xef\xbb\xbft,a\n",
            b"% comment\n1 2 3\n",
            b"MDF,a\n0,1\n",
            b"PAR1,PAR2\n0,1\n",
            b"ORC\n",
            b"%time,field.q\n",
        ] {
            assert_eq!(Kind::of(text), None, "{text:?}");
        }
    }
}
