-- Who is told of the end of jobs, and what was told: see store/webhooks.rs.

CREATE TABLE webhooks (
    id              TEXT PRIMARY KEY NOT NULL, -- UUID v7: sorts by age
    project         TEXT NOT NULL,
    url             TEXT NOT NULL,
    events          TEXT NOT NULL,             -- JSON
    secret          TEXT NOT NULL,             -- signs, so it cannot be a digest
    previous_secret TEXT,                      -- signs, too, until then
    previous_until  TEXT,
    created         TEXT NOT NULL,
    disabled        TEXT                       -- since the receiver answered that it is gone
);
CREATE INDEX webhooks_of_project ON webhooks (project, id);

CREATE TABLE deliveries (
    id       TEXT PRIMARY KEY NOT NULL,        -- UUID v7; the receiver tells repetitions by it
    webhook  TEXT NOT NULL REFERENCES webhooks (id),
    type     TEXT NOT NULL,                    -- job.succeeded, ...
    job      TEXT NOT NULL,
    created  TEXT NOT NULL,
    attempts BIGINT NOT NULL DEFAULT 0,
    next     TEXT,                             -- when it is due; NULL: it is over
    done     TEXT,                             -- when it arrived
    status   BIGINT,                           -- what was answered last
    fault    TEXT                              -- or why there was no answer
);
CREATE INDEX deliveries_due ON deliveries (next);
CREATE INDEX deliveries_of_webhook ON deliveries (webhook, id);
