-- Columns are text, bigint, double and blob only, so that every database the store may live in has them.
-- Times are RFC 3339 UTC with milliseconds, which sort as text.

CREATE TABLE maneuvers (
    id      TEXT PRIMARY KEY NOT NULL,  -- SHA-256 of the canonical content
    name    TEXT NOT NULL,
    created TEXT NOT NULL,
    summary TEXT NOT NULL,              -- JSON
    content BLOB NOT NULL               -- see store/columns.rs
);
CREATE INDEX maneuvers_by_age ON maneuvers (created, id);

CREATE TABLE models (
    id       TEXT PRIMARY KEY NOT NULL, -- UUID v7: sorts by age
    name     TEXT NOT NULL,
    title    TEXT NOT NULL,
    created  TEXT NOT NULL,
    document TEXT NOT NULL              -- JSON
);

CREATE TABLE jobs (
    id          TEXT PRIMARY KEY NOT NULL, -- UUID v7: sorts by age
    kind        TEXT NOT NULL,
    name        TEXT NOT NULL,
    tags        TEXT NOT NULL,             -- JSON
    status      TEXT NOT NULL,             -- always what the fold of the events says
    created     TEXT NOT NULL,
    started     TEXT,
    finished    TEXT,
    last_seq    BIGINT NOT NULL,           -- of the events
    attempt     BIGINT NOT NULL,           -- counts claims; the fence
    lost        BIGINT NOT NULL,           -- counts workers that vanished while they had it
    lease_owner TEXT,
    lease_until TEXT,
    spec        TEXT NOT NULL,             -- JSON as submitted
    model       TEXT NOT NULL              -- JSON of the model that the spec names
);
CREATE INDEX jobs_by_status ON jobs (status, id);

CREATE TABLE job_tags (
    tag TEXT NOT NULL,
    job TEXT NOT NULL REFERENCES jobs (id),
    PRIMARY KEY (tag, job)
);

CREATE TABLE events (
    job  TEXT NOT NULL REFERENCES jobs (id),
    seq  BIGINT NOT NULL,               -- from 1, without holes
    at   TEXT NOT NULL,
    type TEXT NOT NULL,
    body TEXT NOT NULL,                 -- JSON
    PRIMARY KEY (job, seq)
) WITHOUT ROWID;

CREATE TABLE results (
    job  TEXT NOT NULL REFERENCES jobs (id),
    part TEXT NOT NULL,                 -- estimate, model, history/0, history/1, ...
    body BLOB NOT NULL,
    PRIMARY KEY (job, part)
);
