//! Headless Chromium that a test looks at the pages with, driven by the chromedriver that `tests/browser` has started.

use std::cell::{Cell, RefCell};
use std::os::unix::fs::MetadataExt;
use std::panic::{AssertUnwindSafe, resume_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use fantoccini::actions::{
    InputSource, KeyAction, KeyActions, MOUSE_BUTTON_LEFT, MouseActions, PointerAction,
};
use fantoccini::elements::Element;
use fantoccini::key::Key;
use fantoccini::{Client, ClientBuilder, Locator};
use futures_util::FutureExt;
use hyper_util::client::legacy::connect::HttpConnector;
use reqwest::Url;
use serde_json::{Value, json};
use tokio::time::sleep;

use super::chromedriver::Post;

/// How long a page may take on a busy machine before it counts as stuck.
const PATIENCE: Duration = Duration::from_secs(60);
const EVERY: Duration = Duration::from_millis(50);

/// A window with one page.
pub(crate) struct Browser {
    client: Client,
    /// What the console may complain of, for the test provokes it.
    expected: RefCell<Vec<String>>,
    pictures: Cell<usize>,
    title: String,
}

/// Opens a browser, lives the story in it and closes it, however that ends. At the end the console must be free of
/// errors. Where there is no browser the story is skipped, which is said loudly; with TRIMTAB_REQUIRE_BROWSER that is a
/// failure.
///
/// # Panics
/// The story did, or the console has errors.
pub(crate) async fn browse(title: &str, story: impl AsyncFnOnce(&Browser)) {
    let Ok(driver) = std::env::var("TRIMTAB_TEST_WEBDRIVER") else {
        let required = std::env::var_os("TRIMTAB_REQUIRE_BROWSER").is_some();
        assert!(!required, "TRIMTAB_TEST_WEBDRIVER is not set");
        eprintln!("SKIPPED {title}: there is no browser; run it by tests/browser cargo test");
        return;
    };
    let browser = Browser::open(&driver, title).await;
    let told = async {
        story(&browser).await;
        let errors = browser.console_errors().await;
        assert!(errors.is_empty(), "the console has errors:\n{errors:#?}");
    };
    let ended = AssertUnwindSafe(told).catch_unwind().await;
    if ended.is_err() {
        browser.tell_where_it_failed().await;
    }
    let _ = browser.client.close().await;
    if let Err(panic) = ended {
        resume_unwind(panic);
    }
}

impl Browser {
    async fn open(driver: &str, title: &str) -> Self {
        let mut arguments = vec![
            "--headless=new",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--disable-background-networking",
            "--disable-crash-reporter",
            "--hide-scrollbars",
            "--lang=en-US",
            "--no-first-run",
            "--no-proxy-server",
        ];
        // its sandbox refuses to work for root
        if std::fs::metadata("/proc/self").is_ok_and(|me| me.uid() == 0) {
            arguments.push("--no-sandbox");
        }
        let capabilities = json!({
            "browserName": "chrome",
            "goog:chromeOptions": {"args": arguments},
            "goog:loggingPrefs": {"browser": "ALL"},
            "timeouts": {"script": 60_000, "pageLoad": 60_000},
        });
        let Value::Object(capabilities) = capabilities else {
            unreachable!("it is one");
        };
        let mut builder = ClientBuilder::new(HttpConnector::new());
        let client = builder.capabilities(capabilities).connect(driver).await;
        let browser = Self {
            client: client.expect("a browser"),
            expected: RefCell::default(),
            pictures: Cell::new(0),
            title: title.replace(' ', "-"),
        };
        browser.dark(false).await;
        browser.resize(1300, 900).await;
        browser
    }

    /// The size of what is seen of the page; a real window cannot be as narrow as a telephone.
    pub(crate) async fn resize(&self, width: u32, height: u32) {
        let size =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.devtools("Emulation.setDeviceMetricsOverride", size)
            .await;
    }

    /// What the reader's system prefers. Nothing moves by itself: a click would miss it.
    pub(crate) async fn dark(&self, dark: bool) {
        let scheme = if dark { "dark" } else { "light" };
        let features = json!({"features": [
            {"name": "prefers-color-scheme", "value": scheme},
            {"name": "prefers-reduced-motion", "value": "reduce"},
        ]});
        self.devtools("Emulation.setEmulatedMedia", features).await;
    }

    /// Shows the page as it is printed, or as on a screen again.
    pub(crate) async fn print(&self, print: bool) {
        let media = json!({"media": if print { "print" } else { "" }});
        self.devtools("Emulation.setEmulatedMedia", media).await;
    }

    pub(crate) async fn go(&self, address: &str) {
        self.client
            .goto(address)
            .await
            .unwrap_or_else(|error| panic!("{address}: {error}"));
    }

    pub(crate) async fn address(&self) -> Url {
        let address = self.client.current_url().await.expect("an address");
        Url::parse(address.as_str()).expect("a URL")
    }

    /// What a script returns.
    pub(crate) async fn run(&self, script: &str) -> Value {
        let answer = self.client.execute(script, Vec::new()).await;
        answer.unwrap_or_else(|error| panic!("{script}: {error}"))
    }

    /// Waits until an expression of the page's is true, or no more nothing; its value.
    pub(crate) async fn until(&self, expression: &str) -> Value {
        let script = format!("return {expression};");
        let began = Instant::now();
        loop {
            // while a page makes room for another no script runs
            let answer = self.client.execute(&script, Vec::new()).await;
            match answer {
                Ok(value) if !matches!(value, Value::Null | Value::Bool(false)) => return value,
                _ if began.elapsed() < PATIENCE => sleep(EVERY).await,
                _ => panic!("not so after {PATIENCE:?}: {expression}: {answer:?}"),
            }
        }
    }

    /// Waits for an element that can be seen.
    pub(crate) async fn find(&self, selector: &str) -> Element {
        self.until(&format!(
            "document.querySelector({selector:?})?.checkVisibility()"
        ))
        .await;
        let element = self.client.find(Locator::Css(selector)).await;
        element.unwrap_or_else(|error| panic!("{selector}: {error}"))
    }

    /// Waits for an element; all that is written in it.
    pub(crate) async fn text(&self, selector: &str) -> String {
        let text = format!("document.querySelector({selector:?})?.textContent");
        self.until(&text).await.as_str().expect("text").to_string()
    }

    /// Waits until an element says `part`; all that it says.
    pub(crate) async fn says(&self, selector: &str, part: &str) -> String {
        let text = format!("document.querySelector({selector:?})?.textContent");
        self.until(&format!("{text}?.includes({part:?})")).await;
        self.text(selector).await
    }

    /// How many there are now.
    pub(crate) async fn count(&self, selector: &str) -> u64 {
        let script = format!("return document.querySelectorAll({selector:?}).length");
        self.run(&script).await.as_u64().expect("a number")
    }

    pub(crate) async fn click(&self, selector: &str) {
        let began = Instant::now();
        loop {
            let clicked = self.find(selector).await.click().await;
            match clicked {
                Ok(()) => return,
                // it was just replaced by a newer one, or something lay over it
                Err(_) if began.elapsed() < PATIENCE => sleep(EVERY).await,
                Err(error) => panic!("{selector}: {error}"),
            }
        }
    }

    /// Says yes to the question that the page asks.
    pub(crate) async fn accept(&self) {
        let began = Instant::now();
        while let Err(error) = self.client.accept_alert().await {
            assert!(began.elapsed() < PATIENCE, "no question: {error}");
            sleep(EVERY).await;
        }
    }

    pub(crate) async fn choose(&self, selector: &str, value: &str) {
        let select = self.find(selector).await;
        let chosen = select.select_by_value(value).await;
        chosen.unwrap_or_else(|error| panic!("{selector}: {error}"));
    }

    /// Writes into a field; a file field is given paths, one a line.
    pub(crate) async fn fill(&self, selector: &str, text: &str) {
        let field = self.find(selector).await;
        let filled = field.send_keys(text).await;
        filled.unwrap_or_else(|error| panic!("{selector}: {error}"));
    }

    /// Writes into a field in place of what is there.
    pub(crate) async fn correct(&self, selector: &str, text: &str) {
        let cleared = self.find(selector).await.clear().await;
        cleared.unwrap_or_else(|error| panic!("{selector}: {error}"));
        self.fill(selector, text).await;
    }

    /// Presses a key where the focus is.
    pub(crate) async fn press(&self, key: Key) {
        let value = char::from(key);
        let keys = KeyActions::new("keyboard".into())
            .then(KeyAction::Down { value })
            .then(KeyAction::Up { value });
        self.act(keys).await;
    }

    /// Drags from one share of an element's width to another, along its middle.
    pub(crate) async fn drag(&self, selector: &str, from: f64, to: f64) {
        let (left, width, middle) = self.place(selector).await;
        let moved = |share: f64| PointerAction::MoveTo {
            duration: Some(Duration::from_millis(100)),
            x: left + share * width,
            y: middle,
        };
        let button = MOUSE_BUTTON_LEFT;
        let drag = MouseActions::new("mouse".into())
            .then(moved(from))
            .then(PointerAction::Down { button })
            .then(moved((from + to) / 2.0))
            .then(moved(to))
            .then(PointerAction::Up { button });
        self.act(drag).await;
    }

    pub(crate) async fn double_click(&self, selector: &str) {
        let (left, width, middle) = self.place(selector).await;
        let button = MOUSE_BUTTON_LEFT;
        let mut clicks = MouseActions::new("mouse".into()).then(PointerAction::MoveTo {
            duration: None,
            x: left + width / 2.0,
            y: middle,
        });
        for _ in 0..2 {
            clicks = clicks
                .then(PointerAction::Down { button })
                .then(PointerAction::Up { button });
        }
        self.act(clicks).await;
    }

    async fn act(&self, actions: impl Into<fantoccini::actions::ActionSequence>) {
        self.client.perform_actions(actions).await.expect("actions");
        self.client.release_actions().await.expect("no more of it");
    }

    /// Brings an element into view; its left edge, width and vertical middle there.
    async fn place(&self, selector: &str) -> (f64, f64, f64) {
        self.until(&format!("!!document.querySelector({selector:?})"))
            .await;
        let script = format!(
            "const found = document.querySelector({selector:?});
            found.scrollIntoView({{block: 'center'}});
            const place = found.getBoundingClientRect();
            return [place.left, place.width, place.top + place.height / 2];"
        );
        let place = self.run(&script).await;
        let number = |at: usize| place[at].as_f64().expect("a number");
        (number(0), number(1), number(2))
    }

    /// Where the focus is: the element's name and what is written on it.
    pub(crate) async fn focus(&self) -> String {
        let script = "const at = document.activeElement;
            const named = at.getAttribute('aria-label') ?? at.labels?.[0]?.childNodes[0]?.textContent ?? at.textContent;
            return `${at.localName} ${named.trim()}`;";
        self.run(script)
            .await
            .as_str()
            .expect("an element")
            .to_string()
    }

    /// Tabs on until the focus is at `wanted`, which is not far; where it was on the way.
    pub(crate) async fn tab_to(&self, wanted: &str) -> Vec<String> {
        let mut way = Vec::new();
        for _ in 0..40 {
            self.press(Key::Tab).await;
            let at = self.focus().await;
            if at == wanted {
                return way;
            }
            way.push(at);
        }
        panic!("{wanted} is not reached by Tab; these are: {way:#?}");
    }

    /// That nothing sticks out on the side of the page.
    ///
    /// # Panics
    /// Something does.
    pub(crate) async fn fits(&self) {
        let script = "const width = document.documentElement.clientWidth;
            if (document.documentElement.scrollWidth <= width) return [];
            return [...document.body.querySelectorAll('*')]
                .filter(found => found.getBoundingClientRect().right > width + 0.5 && !found.closest('.scroll, pre'))
                .map(found => found.outerHTML.slice(0, 120));";
        let wide = self.run(script).await;
        assert_eq!(wide, json!([]), "wider than the page");
    }

    /// Complaints of the console with this in them are no failure from here on.
    pub(crate) fn expect_error(&self, part: &str) {
        self.expected.borrow_mut().push(part.to_string());
    }

    async fn console_errors(&self) -> Vec<String> {
        let command = Post("se/log", json!({"type": "browser"}));
        let log = self.client.issue_cmd(command).await.expect("the console");
        let entries = log.as_array().expect("entries").iter();
        entries
            .filter(|entry| entry["level"] == "SEVERE")
            .map(|entry| entry["message"].as_str().expect("text").to_string())
            .filter(|text| {
                let expected = self.expected.borrow();
                !expected.iter().any(|part| text.contains(part.as_str()))
            })
            .collect()
    }

    /// Holds the page against the rules of accessibility that a program can check.
    ///
    /// # Panics
    /// It breaks some.
    pub(crate) async fn is_accessible(&self) {
        let Some(axe) = std::env::var_os("TRIMTAB_TEST_AXE") else {
            eprintln!(
                "NOT CHECKED {}: accessibility, for there is no axe-core",
                self.title
            );
            return;
        };
        let axe = std::fs::read_to_string(axe).expect("axe-core");
        self.run(&axe).await;
        let check = "const done = arguments[arguments.length - 1];
            const inWords = ({ id, help, nodes }) => nodes.map(node => `${id}: ${help}: ${node.target.join(' ')}: ${node.failureSummary}`);
            axe.run(document, { resultTypes: ['violations'] })
                .then(({ violations }) => done(violations.flatMap(inWords)), error => done([`${error}`]));";
        let found = self.client.execute_async(check, Vec::new()).await;
        let found = found.expect("axe-core runs");
        let found: Vec<&str> = (found.as_array().expect("a list").iter())
            .filter_map(Value::as_str)
            .collect();
        let address = self.address().await;
        assert!(found.is_empty(), "{address}:\n{}", found.join("\n"));
    }

    /// Keeps a picture of the whole page, if TRIMTAB_SCREENSHOTS names a directory for them.
    pub(crate) async fn picture(&self, name: &str) {
        let Some(directory) = std::env::var_os("TRIMTAB_SCREENSHOTS") else {
            return;
        };
        let directory = Path::new(&directory);
        let number = self.pictures.replace(self.pictures.get() + 1);
        let whole = json!({"captureBeyondViewport": true});
        let picture = self.devtools("Page.captureScreenshot", whole).await;
        let data = picture["data"].as_str().expect("a picture");
        let data = BASE64_STANDARD.decode(data).expect("base64");
        std::fs::create_dir_all(directory).expect("a directory");
        let path = directory.join(format!("{}-{number}-{name}.png", self.title));
        std::fs::write(path, data).expect("written");
    }

    async fn tell_where_it_failed(&self) {
        let address = self.client.current_url().await;
        let text = "return document.body?.innerText?.slice(0, 2000)";
        let text = self.client.execute(text, Vec::new()).await;
        eprintln!("the page is {address:?}; it says: {text:?}");
        // of a browser that is gone there is no more to tell
        let more = async {
            self.picture("failed").await;
            eprintln!("errors of the console: {:#?}", self.console_errors().await);
        };
        let _ = AssertUnwindSafe(more).catch_unwind().await;
    }

    async fn devtools(&self, command: &str, parameters: Value) -> Value {
        let body = json!({"cmd": command, "params": parameters});
        let answer = self.client.issue_cmd(Post("goog/cdp/execute", body)).await;
        answer.unwrap_or_else(|error| panic!("{command}: {error}"))
    }
}
