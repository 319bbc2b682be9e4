-- Projects that see nothing of each other, keys that open them, and an order of the queue that is fair between keys.

CREATE TABLE keys (
    id           TEXT PRIMARY KEY NOT NULL, -- UUID v7: sorts by age
    project      TEXT NOT NULL,
    name         TEXT NOT NULL,
    digest       TEXT NOT NULL UNIQUE,      -- SHA-256 of the key, which is kept nowhere
    scopes       TEXT NOT NULL,             -- JSON
    max_priority BIGINT NOT NULL,
    created      TEXT NOT NULL,
    expires      TEXT,
    revoked      TEXT,
    used         TEXT                       -- about when it was last used
);

-- What was here before keys were is the project 'default'.
ALTER TABLE jobs ADD COLUMN project TEXT NOT NULL DEFAULT 'default';
ALTER TABLE jobs ADD COLUMN submitter TEXT NOT NULL DEFAULT '';     -- the key, by its id
ALTER TABLE jobs ADD COLUMN priority BIGINT NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN turn BIGINT NOT NULL DEFAULT 0;         -- see store/queue.rs
CREATE INDEX jobs_of_project ON jobs (project, id);
CREATE INDEX jobs_in_line ON jobs (status, priority DESC, turn, id);
CREATE INDEX jobs_by_turn ON jobs (turn);
CREATE INDEX jobs_by_status_and_turn ON jobs (status, turn);
CREATE INDEX jobs_of_submitter ON jobs (submitter, status, turn);

ALTER TABLE models ADD COLUMN project TEXT NOT NULL DEFAULT 'default';
CREATE INDEX models_of_project ON models (project, id);

-- Two projects may hold the same maneuver, each for itself.
CREATE TABLE maneuvers_of_projects (
    project TEXT NOT NULL,
    id      TEXT NOT NULL,              -- SHA-256 of the canonical content
    name    TEXT NOT NULL,
    created TEXT NOT NULL,
    summary TEXT NOT NULL,              -- JSON
    content BLOB NOT NULL,              -- see store/columns.rs
    bytes   BIGINT NOT NULL,            -- of the content
    PRIMARY KEY (project, id)
);
INSERT INTO maneuvers_of_projects (project, id, name, created, summary, content, bytes)
    SELECT 'default', id, name, created, summary, content, LENGTH(content) FROM maneuvers;
DROP TABLE maneuvers;
ALTER TABLE maneuvers_of_projects RENAME TO maneuvers;
CREATE INDEX maneuvers_by_age ON maneuvers (project, created, id);

-- An Idempotency-Key is its sender's own.
CREATE TABLE answers_of_submitters (
    submitter TEXT NOT NULL,            -- the key that opened the project, by its id
    key       TEXT NOT NULL,
    request   TEXT NOT NULL,            -- SHA-256 of what was asked
    resource  TEXT NOT NULL,            -- UUID v7 that a resource gets which the request makes
    until     TEXT NOT NULL,            -- in hand until then, or kept until then
    answer    TEXT,                     -- JSON; NULL while the request is in hand
    body      BLOB,
    PRIMARY KEY (submitter, key)
);
INSERT INTO answers_of_submitters (submitter, key, request, resource, until, answer, body)
    SELECT '', key, request, resource, until, answer, body FROM answers;
DROP TABLE answers;
ALTER TABLE answers_of_submitters RENAME TO answers;
CREATE INDEX answers_by_age ON answers (until);
