//! Files that pages load.

/// A file as it is served.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Asset {
    pub media_type: &'static str,
    pub content: &'static str,
}

/// The file of that name under `/assets/`.
pub fn asset(name: &str) -> Option<Asset> {
    let (media_type, content) = match name {
        "follow.js" => ("text/javascript", include_str!("assets/follow.js")),
        _ => return None,
    };
    Some(Asset {
        media_type,
        content,
    })
}
