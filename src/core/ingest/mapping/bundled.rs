//! The mappings that come with Trimtab.

/// By name.
pub(super) const BUNDLED: [(&str, &str); 16] = [
    ("ardupilot", include_str!("ardupilot.toml")),
    (
        "betaflight-blackbox",
        include_str!("betaflight-blackbox.toml"),
    ),
    ("dynon-skyview", include_str!("dynon-skyview.toml")),
    ("fvsysid-attas", include_str!("fvsysid-attas.toml")),
    ("fvsysid-hfb320", include_str!("fvsysid-hfb320.toml")),
    ("garmin-g1000", include_str!("garmin-g1000.toml")),
    ("garmin-g3x", include_str!("garmin-g3x.toml")),
    ("jsbsim", include_str!("jsbsim.toml")),
    ("labview", include_str!("labview.toml")),
    ("px4", include_str!("px4.toml")),
    ("px4-ulog2csv", include_str!("px4-ulog2csv.toml")),
    ("rostopic", include_str!("rostopic.toml")),
    ("sidpac", include_str!("sidpac.toml")),
    ("vbox", include_str!("vbox.toml")),
    ("x-plane", include_str!("x-plane.toml")),
    ("xsens", include_str!("xsens.toml")),
];
