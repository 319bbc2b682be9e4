//! How texts of programs begin, and seeds that go on from there, which `tests/ingest` tries as well.

/// A seed of `tests/fuzz/seeds`, and what is put before it. Those of `programs` begin with a byte that chooses among them in
/// this order.
pub(crate) const BEGINNINGS: [(&str, &str); 7] = [
    (
        "flysight/sensor.csv",
        "$FLYS,1\n$COL,BARO,time,pressure\n$COL,",
    ),
    (
        "programs/octave.txt",
        "# Created by Octave 8.4.0\n# name: t\n# type: ",
    ),
    ("programs/ames.txt", "14 1001\n"),
    (
        "programs/ardupilot.txt",
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 130, 40, IMU, QBff, TimeUS,I,GyrX,GyrY\n",
    ),
    ("programs/tecplot.txt", "VARIABLES = \"t [s]\" \"a\"\n"),
    ("programs/vbox.txt", "[column names]\n"),
    (
        "programs/labchart.txt",
        "Interval=\t0.02 s\nChannelTitle=\t",
    ),
];
