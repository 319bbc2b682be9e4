-- What was flown: aircraft, configuration, mass, notes and tags of a recording, which may be edited.

ALTER TABLE maneuvers ADD COLUMN flown TEXT NOT NULL DEFAULT '{}'; -- JSON

-- By what recordings are found: tags, and what flew where.
CREATE TABLE maneuver_marks (
    project  TEXT NOT NULL,
    mark     TEXT NOT NULL, -- tag, aircraft, registration, flight, test_point
    value    TEXT NOT NULL,
    maneuver TEXT NOT NULL,
    PRIMARY KEY (project, mark, value, maneuver),
    FOREIGN KEY (project, maneuver) REFERENCES maneuvers (project, id) ON DELETE CASCADE
);
CREATE INDEX marks_of_maneuver ON maneuver_marks (project, maneuver);
