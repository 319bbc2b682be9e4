-- Where the channels of recordings are that do not say it themselves: the project's own mapping documents.

CREATE TABLE mappings (
    project  TEXT NOT NULL,
    name     TEXT NOT NULL,
    created  TEXT NOT NULL,
    document TEXT NOT NULL, -- JSON
    PRIMARY KEY (project, name)
);
