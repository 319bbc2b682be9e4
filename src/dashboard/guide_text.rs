//! Markdown as the guide has it, made HTML: headings that can be linked to, tables and code that can be scrolled, and links
//! between files that become links between pages.

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};

/// A page of Markdown as HTML.
#[derive(Debug)]
pub(super) struct Rendered {
    /// Its first heading.
    pub title: String,
    /// Its headings of the second level: text and anchor.
    pub sections: Vec<(String, String)>,
    pub html: String,
}

/// Renders a page. HTML in it is shown and not passed on.
pub(super) fn rendered(markdown: &str) -> Rendered {
    let parser = Parser::new_ext(markdown, Options::ENABLE_TABLES);
    let mut events: Vec<Event<'_>> = Vec::new();
    let mut page = Rendered {
        title: String::new(),
        sections: Vec::new(),
        html: String::new(),
    };
    let mut heading: Option<Heading> = None;
    for event in parser {
        if let Some(open) = &mut heading {
            open.read(&event);
        }
        match event {
            Event::Start(Tag::Heading { level, .. }) => {
                heading = Some(Heading {
                    level,
                    at: events.len(),
                    text: String::new(),
                });
            }
            Event::End(TagEnd::Heading(level)) => {
                if let Some(open) = heading.take() {
                    let anchor = anchor(&open.text);
                    let begin = format!("<{level} id=\"{anchor}\">");
                    events.insert(open.at, Event::Html(begin.into()));
                    open.note(anchor, &mut page);
                }
                events.push(Event::Html(format!("</{level}>\n").into()));
            }
            other => plain(other, &mut events),
        }
    }
    html::push_html(&mut page.html, events.into_iter());
    page
}

/// A heading that is being read.
struct Heading {
    level: HeadingLevel,
    /// Where it begins among the events.
    at: usize,
    text: String,
}

impl Heading {
    fn read(&mut self, event: &Event<'_>) {
        if let Event::Text(text) | Event::Code(text) = event {
            self.text.push_str(text);
        }
    }

    fn note(self, anchor: String, page: &mut Rendered) {
        match self.level {
            HeadingLevel::H1 if page.title.is_empty() => page.title = self.text,
            HeadingLevel::H2 => page.sections.push((self.text, anchor)),
            _ => {}
        }
    }
}

/// Whatever is no heading.
fn plain<'a>(event: Event<'a>, events: &mut Vec<Event<'a>>) {
    match event {
        Event::Start(Tag::Table(columns)) => {
            let around = r#"<div class="scroll" tabindex="0" role="group" aria-label="Table">"#;
            events.push(Event::Html(around.into()));
            events.push(Event::Start(Tag::Table(columns)));
        }
        Event::End(TagEnd::Table) => {
            events.push(Event::End(TagEnd::Table));
            events.push(Event::Html("</div>\n".into()));
        }
        Event::Start(Tag::CodeBlock(_)) => {
            let around = r#"<pre tabindex="0"><code>"#;
            events.push(Event::Html(around.into()));
        }
        Event::End(TagEnd::CodeBlock) => events.push(Event::Html("</code></pre>\n".into())),
        Event::Start(Tag::Link {
            link_type,
            dest_url,
            title,
            id,
        }) => events.push(Event::Start(Tag::Link {
            link_type,
            dest_url: address(dest_url),
            title,
            id,
        })),
        Event::Start(Tag::Image {
            link_type,
            dest_url,
            title,
            id,
        }) => events.push(Event::Start(Tag::Image {
            link_type,
            dest_url: format!("/guide/{dest_url}").into(),
            title,
            id,
        })),
        Event::Html(text) | Event::InlineHtml(text) => events.push(Event::Text(text)),
        other => events.push(other),
    }
}

/// Where a link between files leads among pages: `findings.md#gap` to `/guide/findings#gap`.
fn address(link: CowStr<'_>) -> CowStr<'_> {
    let (file, anchor) = match link.split_once('#') {
        Some((file, anchor)) => (file, format!("#{anchor}")),
        None => (link.as_ref(), String::new()),
    };
    match file.strip_suffix(".md") {
        Some("index") => format!("/guide{anchor}").into(),
        Some(page) if !page.contains('/') => format!("/guide/{page}{anchor}").into(),
        _ => link,
    }
}

/// The anchor of a heading, as forges make it: lower case, blanks as hyphens, no punctuation.
fn anchor(text: &str) -> String {
    let kept = text.chars().filter_map(|letter| match letter {
        ' ' => Some('-'),
        '-' | '_' => Some(letter),
        letter if letter.is_alphanumeric() => Some(letter.to_ascii_lowercase()),
        _ => None,
    });
    kept.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_rendered_as_a_forge_would() {
        let page = rendered(
            "# The `fit`\n\nSee [gaps](findings.md#gap), [home](index.md), [API](/docs/).\n\n## Two words, more\n\n\
             ![picture](pictures/a.svg)\n\n```sh\na < b\n```\n\n| a |\n|---|\n| <b> |\n",
        );
        assert_eq!(page.title, "The fit");
        assert_eq!(
            page.sections,
            [("Two words, more".to_string(), "two-words-more".to_string())]
        );
        for part in [
            "<h1 id=\"the-fit\">The <code>fit</code></h1>",
            "href=\"/guide/findings#gap\"",
            "href=\"/guide\"",
            "href=\"/docs/\"",
            "<h2 id=\"two-words-more\">",
            "src=\"/guide/pictures/a.svg\"",
            "<code>a &lt; b\n</code></pre>",
            "<td>&lt;b&gt;</td>",
        ] {
            assert!(page.html.contains(part), "{part} in {}", page.html);
        }
    }
}
