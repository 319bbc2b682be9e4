//! The mappings that come with Trimtab.

/// By name.
pub(super) const BUNDLED: [(&str, &str); 3] = [
    ("fvsysid-attas", include_str!("fvsysid-attas.toml")),
    ("fvsysid-hfb320", include_str!("fvsysid-hfb320.toml")),
    ("sidpac", include_str!("sidpac.toml")),
];
