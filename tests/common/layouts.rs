//! Small files of our own making in the layouts of loggers, simulators and programs.

/// A layout, a file in it, and a channel with its first value in a unit.
pub(crate) struct Layout {
    pub(crate) name: &'static str,
    pub(crate) file: &'static str,
    /// Where the file cannot say itself what is what.
    pub(crate) mapping: Option<&'static str>,
    pub(crate) samples: usize,
    pub(crate) duration: f64,
    pub(crate) channel: (&'static str, f64, &'static str),
}

const BY_NUMBER: &str = r#"
time = {from = "(:,1)", unit = "s"}
[channels]
alpha = {from = "(:,2)", unit = "deg"}
q = {from = "(:,3)", unit = "deg/s"}
"#;

pub(crate) fn layouts() -> Vec<Layout> {
    let layout = |name, file, samples, duration, channel| Layout {
        name,
        file,
        mapping: None,
        samples,
        duration,
        channel,
    };
    vec![
        layout(
            "Garmin G1000",
            "#airframe_info, log_version=\"1.00\", airframe_name=\"Own Making\"\n\
             #yyy-mm-dd, hh:mm:ss,   hh:mm,  ident,      degrees,      degrees, ft Baro,  ft msl, deg C,     kt,     fpm,    deg,    deg,      G,      G, volts, rpm, bool\n\
             \x20 Lcl Date, Lcl Time, UTCOfst, AtvWpt,     Latitude,    Longitude,    AltB,  AltMSL,   OAT,    IAS,    VSpd,  Pitch,   Roll,  LatAc, NormAc, volt1, E1 RPM, HAL\n\
             \x20         ,         ,        ,       ,             ,             ,        ,        ,  20.1,   0.00,        ,       ,       ,       ,       ,  24.1,  0.0, 0\n\
             2026-03-01, 10:15:00,  +01:00,   KXYZ,   47.1000000,    8.1000000,  4200.0,  4311.2,  14.1,  95.00,   10.20,   2.50,  -1.00,   0.01,  -0.02,  28.1, 2400.1, 0\n\
             2026-03-01, 10:15:01,  +01:00,   KXYZ,   47.1000100,    8.1000200,  4201.0,  4312.2,  14.1,  95.50,   11.20,   2.60,  -1.10,   0.01,  -0.01,  28.1, 2400.2, 0\n\
             2026-03-01, 10:15:02,  +01:00,   KXYZ,   47.1000200,    8.1000400,  4202.0,  4313.2,  14.0,  96.00,   12.20,   2.70,  -1.20,   0.01,  -0.03,  28.1, 2400.3, 0\n",
            3,
            2.0,
            ("theta", 2.5, "deg"),
        ),
        layout(
            "Garmin G3X Touch",
            "#airframe_info,log_version=\"2.00\",product=\"own making\"\n\
             Lcl Date (yyyy-mm-dd),Lcl Time (hh:mm:ss),UTC Offset (hh:mm),Latitude (deg),GPS Altitude (ft),Indicated Airspeed (kt),True Airspeed (kt),Pitch (deg),Roll (deg),Lateral Acceleration (G),Normal Acceleration (G),CAS Alert\n\
             2026-03-01,10:15:00,+01:00,47.1,4311,95.1,101.2,2.5,-1.0,0.01,1.02,\n\
             2026-03-01,10:15:01,+01:00,47.1,4312,95.2,101.3,2.6,-1.1,0.01,1.01,\n",
            2,
            1.0,
            ("V", 101.2, "kt"),
        ),
        layout(
            "Dynon SkyView",
            "Session Time,System Time,GPS Fix Quality,Pitch (deg),Roll (deg),Indicated Airspeed (knots),Pressure Altitude (ft),Lateral Accel (g),Angle of Attack (%),OAT (deg C),RPM L\n\
             100.0625,10:15:00,2,2.5,-1.0,95,4200,0.01,32,14,2400\n\
             100.1250,10:15:00,2,2.6,-1.1,96,4201,0.01,33,14,2400\n\
             100.1875,10:15:00,2,2.7,-1.2,96,4202,0.02,33,14,2410\n",
            3,
            0.125,
            ("theta", 2.5, "deg"),
        ),
        layout(
            "PX4, ulog2csv",
            "timestamp,timestamp_sample,xyz[0],xyz[1],xyz[2]\n\
             4000000,3999900,0.1,0.2,0.3\n4004000,4003900,0.1,0.2,0.3\n4008000,4007900,0.1,0.25,0.3\n",
            3,
            0.008,
            ("xyz_1", 0.2, "-"),
        ),
        layout(
            "Betaflight, blackbox_decode",
            "loopIteration, time (us), axisP[0], gyroADC[0], gyroADC[1], gyroADC[2], motor[0], flightModeFlags (flags), stateFlags (flags)\n\
             0, 1000000, -3, 12, -7, 1, 1100, ANGLE_MODE, SMALL_ANGLE\n\
             8, 1002000, -3, 13, -8, 1, 1100, ANGLE_MODE, SMALL_ANGLE\n",
            2,
            0.002,
            ("gyro_pitch", -7.0, "deg/s"),
        ),
        layout(
            "iNAV, log viewer",
            "\"Product\",\"Blackbox flight data recorder\"\n\"gyroScale\",\"0x3f800000\"\n\
             \"loopIteration\",\"time\",\"axisRate[0]\",\"gyroADC[0]\",\"gyroADC[1]\",\"gyroADC[2]\",\"attitude[0]\"\n\
             0,1000000,1,12,-7,1,30\n8,1002000,1,13,-8,1,30\n16,1004000,1,13,-8,1,31\n",
            3,
            0.004,
            ("gyro_roll", 12.0, "deg/s"),
        ),
        layout(
            "X-Plane, Data.txt",
            "\n    _real,_time |    totl,_time |    _Vind,_kias |   pitch,__deg |   _roll,__deg |   alpha,__deg |   ____Q,rad/s |   Gload,norml | \n\
             \x20    100.00000 |      90.00000 |      95.00000 |       2.50000 |      -1.00000 |       3.00000 |       0.01000 |       1.02000 | \n\
             \x20    100.05000 |      90.05000 |      95.10000 |       2.60000 |      -1.10000 |       3.10000 |       0.02000 |       1.01000 | \n",
            2,
            0.05,
            ("alpha", 3.0, "deg"),
        ),
        layout(
            "JSBSim",
            "Time,Altitude ASL (ft),Alpha (deg),Beta (deg),P (deg/s),Q (deg/s),R (deg/s),V_{Total} (ft/s),/fdm/jsbsim/fcs/elevator-pos-rad\n\
             0,4200,3.0,0,0,0.5,0,160,-0.02\n0.0083333,4200,3.1,0,0,0.6,0,160,-0.02\n0.0166667,4200,3.2,0,0,0.7,0,160,-0.02\n",
            3,
            0.016_666_7,
            ("q", 0.5, "deg/s"),
        ),
        layout(
            "IADS, rows of descriptions",
            "Test Point,12\nAircraft,Own Making\n\nTime,ALPHA_B,Q_B,DE_POS\nIRIG,Boom angle of attack,Body pitch rate,Elevator position\n,DEG,DEG/SEC,DEG\n\
             060:10:15:00.000000,3.0,0.5,-1.0\n060:10:15:00.020000,3.1,0.6,-1.0\n060:10:15:00.040000,3.2,0.7,-1.0\n",
            3,
            0.04,
            ("ALPHA_B", 3.0, "deg"),
        ),
        layout(
            "LabVIEW, .lvm",
            "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\nX_Columns\tOne\nTime_Pref\tRelative\nDate\t2026/03/01\nTime\t10:15:00,5\n***End_of_Header***\t\n\t\n\
             Channels\t3\t\t\t\nSamples\t3\t3\t3\t\nDate\t2026/03/01\t2026/03/01\t2026/03/01\t\nTime\t10:15:00,5\t10:15:00,5\t10:15:00,5\t\nY_Unit_Label\tdeg\tdeg\tdeg/s\t\nX_Dimension\tTime\tTime\tTime\t\nX0\t0,0\t0,0\t0,0\t\nDelta_X\t0,020000\t0,020000\t0,020000\t\n***End_of_Header***\t\t\t\t\n\
             X_Value\tElevator\tAlpha\tPitch rate\tComment\n\
             0,000000\t-1,000000\t3,000000\t0,500000\n0,020000\t-1,000000\t3,100000\t0,600000\n0,040000\t-1,000000\t3,200000\t0,700000\n0,060000\t-1,000000\t3,100000\t0,600000\n0,080000\t-1,000000\t3,000000\t0,500000\n",
            5,
            0.08,
            ("Alpha", 3.0, "deg"),
        ),
        layout(
            "Dewesoft export",
            "Data file;own making.dxd\nStart time;01.03.2026 10:15:00\nSample rate;50\n\nTime (s);Alpha (deg);Pitch rate (deg/s)\n0,000000;3,000;0,500\n0,020000;3,100;0,600\n0,040000;3,200;0,700\n",
            3,
            0.04,
            ("Alpha", 3.0, "deg"),
        ),
        layout(
            "OpenRocket",
            "# Own rocket (not up to date)\n# Time (s),Altitude (m),Vertical velocity (m/s),Pitch rate (\u{b0}/s),Mach number (\u{200b})\n# Event LAUNCH occurred at t=0 seconds\n0,0,0,0.5,0\n0.01,0.1,1,0.6,0.003\n# Event LIFTOFF occurred at t=0.01 seconds\n0.02,0.2,2,0.7,0.006\n",
            3,
            0.02,
            ("Pitch_rate", 0.5, "deg/s"),
        ),
        layout(
            "FlySight",
            "time,lat,lon,hMSL,velN,velE,velD,heading,gpsFix,numSV\n,(deg),(deg),(m),(m/s),(m/s),(m/s),(deg),,\n2026-03-01T10:15:00.00Z,47.1,8.1,1311.2,40.1,3.2,-1.5,4.5,3,12\n2026-03-01T10:15:00.20Z,47.1,8.1,1311.5,40.2,3.2,-1.6,4.6,3,12\n",
            2,
            0.2,
            ("velN", 40.1, "m/s"),
        ),
        layout(
            "Airdata, DJI",
            "time(millisecond),datetime(utc),latitude,longitude,altitude(feet),speed(mph), xSpeed(mph), pitch(degrees), roll(degrees),isVideo,voltage(v),flycState,message\n\
             0,2026-03-01 10:15:00,47.1,8.1,10,1.5,0.5,-2.5,0.4,0,15.1,P-GPS,\n100,2026-03-01 10:15:00,47.1,8.1,10,1.6,0.6,-2.6,0.5,0,15.1,P-GPS,Home point recorded\n",
            2,
            0.1,
            ("pitch", -2.5, "deg"),
        ),
        layout(
            "rostopic echo -p",
            "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angular_velocity.x,field.angular_velocity.y\n\
             1772360100000000000,1,1772360100000000000,base,0.01,0.02\n1772360100020000000,2,1772360100020000000,base,0.02,0.03\n",
            2,
            0.02,
            ("field_angular_velocity_y", 0.02, "-"),
        ),
        layout(
            "MATLAB, writetimetable",
            "Time,alpha_deg,q_deg_s\n0 sec,3,0.5\n0.02 sec,3.1,0.6\n0.04 sec,3.2,0.7\n",
            3,
            0.04,
            ("q_deg_s", 0.5, "deg/s"),
        ),
        Layout {
            mapping: Some(BY_NUMBER),
            ..layout(
                "MATLAB, csvwrite",
                "0,3,0.5\n0.02,3.1,0.6\n0.04,3.2,0.7\n",
                3,
                0.04,
                ("q", 0.5, "deg/s"),
            )
        },
        layout(
            "numpy, savetxt with a header",
            "# t[s] alpha[deg] q[deg/s]\n0.000000000000000000e+00 3.000000000000000000e+00 5.000000000000000000e-01\n2.000000000000000042e-02 3.100000000000000089e+00 5.999999999999999778e-01\n",
            2,
            0.02,
            ("q", 0.5, "deg/s"),
        ),
        Layout {
            mapping: Some(BY_NUMBER),
            ..layout(
                "numpy, savetxt",
                "0.00e+00 3.0e+00 5.0e-01\n2.0e-02 3.1e+00 6.0e-01\n",
                2,
                0.02,
                ("q", 0.5, "deg/s"),
            )
        },
        layout(
            "pandas, to_csv",
            ",t[s],alpha[deg],on_ground\n0,0.0,3.0,False\n1,0.02,3.1,False\n2,0.04,3.2,True\n",
            3,
            0.04,
            ("alpha", 3.0, "deg"),
        ),
        layout(
            "pandas, to_csv with a DatetimeIndex",
            ",alpha[deg],q[deg/s]\n2026-03-01 10:15:00.000000,3.0,0.5\n2026-03-01 10:15:00.020000,3.1,0.6\n",
            2,
            0.02,
            ("q", 0.5, "deg/s"),
        ),
        layout(
            "LabChart",
            "Interval=\t0.02 s\nTimeFormat=\tStartOfBlock\nDateFormat=\t\nChannelTitle=\tElevator\tPitch rate\nRange=\t10.000 V\t100.0 V\nUnitName=\tdeg\tdeg/s\n7.00\t-1.5\t0.5\t#1 doublet\n7.02\t-1.5\t0.6\n7.04\t-1.5\t0.7\n",
            3,
            0.04,
            ("Elevator", -1.5, "deg"),
        ),
        layout(
            "CloudAhoy",
            "Metadata,CA_CSV.3\nTAIL,OWN\nDATA,\nseconds/t,degrees/Pitch,feet/ALT (GPS),knots/IAS,G/G-load\n0.0,2.5,4200,95,1.0\n0.5,2.6,4201,95,1.0\n1.0,2.7,4202,95,1.1\n",
            3,
            1.0,
            ("Pitch", 2.5, "deg"),
        ),
        layout(
            "VBOX",
            "File created on 01/03/2026 at 10:15:00\n\n[header]\nsatellites\ntime\n\n[comments]\nown\n\n[column names]\nsats time lat long velocity heading height Pitch\n\n[data]\n012 095959.90 +02826.000000 -00486.000000 172.800 084.10 +01311.20 +2.5\n012 100000.00 +02826.000120 -00486.000060 172.900 084.10 +01311.30 +2.6\n012 100000.10 +02826.000240 -00486.000120 173.000 084.10 +01311.40 +2.7\n",
            3,
            0.2,
            ("V_ground", 48.0, "m/s"),
        ),
        layout(
            "Tecplot",
            "TITLE = \"run\"\nVARIABLES = \"t [s]\"\n\"alpha [deg]\"\n\"q [deg/s]\"\nZONE T=\"run 1\", I=3, F=POINT\n 0.00 3.0 0.5\n 0.02 3.1 0.6\n 0.04 3.2 0.7\n",
            3,
            0.04,
            ("q", 0.5, "deg/s"),
        ),
        layout(
            "R, write.table",
            "\"t [s]\" \"alpha_deg\"\n\"1\" 0 3\n\"2\" 0.1 4\n\"3\" 0.2 5\n",
            3,
            0.2,
            ("alpha_deg", 3.0, "deg"),
        ),
    ]
}
