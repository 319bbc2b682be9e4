//! The guide: pages of Markdown from `src/guide`, which can be read there as they are.

use std::sync::LazyLock;

use super::guide_text::{Rendered, rendered};

/// A page of the guide.
#[derive(Debug)]
pub(super) struct GuidePage {
    /// As it stands in addresses.
    pub name: &'static str,
    pub part: Part,
    pub text: Rendered,
}

/// What a page is for, as the table of contents has them.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Part {
    Begin,
    HowTo,
    Reference,
    Method,
}

impl Part {
    pub(super) const ALL: [Self; 4] = [Self::Begin, Self::HowTo, Self::Reference, Self::Method];

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Begin => "Begin",
            Self::HowTo => "How to",
            Self::Reference => "Reference",
            Self::Method => "Method",
        }
    }
}

macro_rules! pages {
    ($($part:ident $name:literal;)+) => {
        &[$((Part::$part, $name, include_str!(concat!("../guide/", $name, ".md"))),)+]
    };
}

/// Part, name and text, in the order of the table of contents.
const TEXTS: &[(Part, &str, &str)] = pages! {
    Begin "index";
    Begin "tutorial";
    HowTo "clients";
    HowTo "pages";
    HowTo "python";
    HowTo "recordings";
    HowTo "channels";
    HowTo "models";
    HowTo "jobs";
    HowTo "estimators";
    HowTo "results";
    HowTo "diagnosis";
    HowTo "turbulence";
    HowTo "frequency";
    HowTo "in-flight";
    HowTo "structure";
    HowTo "design";
    HowTo "campaigns";
    HowTo "operating";
    Reference "effects";
    Reference "findings";
    Reference "problems";
    Reference "commands";
    Method "method";
    Method "confusion";
    Method "glossary";
    Method "peers";
    Method "development";
};

/// All pages, rendered once.
pub(super) fn pages() -> &'static [GuidePage] {
    static PAGES: LazyLock<Vec<GuidePage>> = LazyLock::new(|| {
        let page = |&(part, name, text): &(Part, &'static str, &'static str)| GuidePage {
            name,
            part,
            text: rendered(text),
        };
        TEXTS.iter().map(page).collect()
    });
    &PAGES
}

/// A picture of the guide by its name: PNG.
pub fn guide_picture(name: &str) -> Option<&'static [u8]> {
    match name {
        "diagnosis.png" => Some(include_bytes!("../guide/pictures/diagnosis.png")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_has_a_title_and_a_part() {
        let pages = pages();
        for (number, page) in pages.iter().enumerate() {
            assert!(!page.text.title.is_empty(), "{}", page.name);
            let names = pages[..number].iter().map(|page| page.name);
            assert!(
                !names.into_iter().any(|name| name == page.name),
                "{}",
                page.name
            );
        }
        for part in Part::ALL {
            assert!(
                pages.iter().any(|page| page.part == part),
                "{}",
                part.title()
            );
        }
    }
}
