-- Requests that carry an Idempotency-Key, and what was answered: sent again, they are answered again and not done again.

CREATE TABLE answers (
    key      TEXT PRIMARY KEY NOT NULL,
    request  TEXT NOT NULL,  -- SHA-256 of what was asked
    resource TEXT NOT NULL,  -- UUID v7 that a resource gets which the request makes
    until    TEXT NOT NULL,  -- in hand until then, or kept until then
    answer   TEXT,           -- JSON; NULL while the request is in hand
    body     BLOB
);
CREATE INDEX answers_by_age ON answers (until);
