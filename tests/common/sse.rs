//! Reading server-sent events as a client does, and cutting the line where a test wants to.

use futures_util::StreamExt;

/// One event as it came over the wire.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Received {
    pub id: u64,
    pub event: String,
    pub data: String,
}

/// A stream of events that is read bytewise, so that it can be cut off anywhere.
pub(crate) struct Stream {
    response: reqwest::Response,
    text: Vec<u8>,
}

impl Stream {
    /// `None` where the server says that nothing follows any more.
    pub(crate) async fn open(url: &str, job: &str, last_event_id: Option<u64>) -> Option<Self> {
        let request = super::server::client().get(format!("{url}/v1/jobs/{job}/events"));
        let mut request = request.header("accept", "text/event-stream");
        if let Some(id) = last_event_id {
            request = request.header("last-event-id", id);
        }
        Self::of(request.send().await.unwrap())
    }

    /// As [`Stream::open`], of a server that may be away.
    pub(crate) async fn try_open(url: &str, job: &str, last_event_id: u64) -> Option<Self> {
        let request = super::server::client()
            .get(format!("{url}/v1/jobs/{job}/events"))
            .header("accept", "text/event-stream")
            .header("last-event-id", last_event_id);
        let response = request.send().await.ok()?;
        if response.status().is_success() {
            Self::of(response)
        } else {
            None
        }
    }

    fn of(response: reqwest::Response) -> Option<Self> {
        if response.status() == 204 {
            return None;
        }
        assert_eq!(response.status(), 200);
        assert_eq!(response.headers()["content-type"], "text/event-stream");
        // a proxy passes on what comes when it comes
        assert_eq!(response.headers()["x-accel-buffering"], "no");
        Some(Self {
            response,
            text: Vec::new(),
        })
    }

    /// The next event; `None` at the end of the stream.
    pub(crate) async fn next(&mut self) -> Option<Received> {
        loop {
            if let Some(end) = self.text.windows(2).position(|pair| pair == b"\n\n") {
                let block: Vec<u8> = self.text.drain(..end + 2).collect();
                if let Some(event) = parse(std::str::from_utf8(&block).unwrap()) {
                    return Some(event);
                }
                continue;
            }
            let chunk = self.response.chunk().await.ok().flatten()?;
            self.text.extend_from_slice(&chunk);
        }
    }

    /// All events to the end of the stream.
    pub(crate) async fn rest(mut self) -> Vec<Received> {
        let mut events = Vec::new();
        while let Some(event) = self.next().await {
            events.push(event);
        }
        events
    }
}

/// The bytes of a whole stream, as they come.
pub(crate) async fn bytes(url: &str, job: &str) -> Vec<u8> {
    let stream = Stream::open(url, job, None).await.unwrap();
    let mut chunks = stream.response.bytes_stream();
    let mut bytes = Vec::new();
    while let Some(Ok(chunk)) = chunks.next().await {
        bytes.extend_from_slice(&chunk);
    }
    bytes
}

/// The events that are complete in the first bytes of a stream: what a client that was cut off there has.
pub(crate) fn complete_in(bytes: &[u8]) -> Vec<Received> {
    let end = bytes
        .windows(2)
        .rposition(|pair| pair == b"\n\n")
        .map_or(0, |at| at + 2);
    let text = std::str::from_utf8(&bytes[..end]).unwrap();
    text.split_inclusive("\n\n").filter_map(parse).collect()
}

/// A block of lines; comments and settings are no event.
fn parse(block: &str) -> Option<Received> {
    let field = |name: &str| {
        let lines = block.lines();
        lines
            .filter_map(|line| line.strip_prefix(name)?.strip_prefix(':'))
            .map(str::trim)
            .next()
    };
    Some(Received {
        id: field("id")?.parse().unwrap(),
        event: field("event")?.to_string(),
        data: field("data")?.to_string(),
    })
}
