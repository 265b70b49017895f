"""Grades classes as ``grader cohort`` does, one exercise after the other, and prints what each work earns as JSON.

``points`` runs this file by itself, with any Python and any installation of the grader.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from grader.cohort.gradebook import gradebook_rows
from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions
from grader.reading import read_assignment
from kit.host.job_folder import JobExecutor
from kit.host.sandbox.sandbox_config import Level


def main() -> None:
    folder, level, jobs = Path(sys.argv[1]), Level(int(sys.argv[2])), int(sys.argv[3])
    table = {}
    for exercise in sorted(folder.iterdir()):
        assignment = read_assignment(exercise / "assignment")
        queue = Queue(exercise / "queue")
        options = GradingOptions(level, assignment.has_secrets, may_lower_level=False)
        prepare_queue(queue, exercise / "in", assignment, options)
        JobExecutor(jobs=jobs).run(queue, queue.waiting(), lambda key: None)
        for row in gradebook_rows(queue):
            table[f"{exercise.name}/{row.name}"] = [
                row.points,
                dict(row.tests),
                dict(row.statuses),
                row.level,
            ]
    print(json.dumps(table))


if __name__ == "__main__":
    main()
