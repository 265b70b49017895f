"""The layer planner: who must touch whom and which laser must see what -> the fewest collision layers, and the proof.

    case = EXAMPLES["slides-lasers"]              requirements.Case: entities, contacts, lasers
    run = greedy(case)                            the slides' method, every step with the choices it had
    plan = solve(case)                            planning.Plan: the optimum, its certificate, or bound and gap
    plan.assignment.layers_of("M2")               ("C3", "C5", "C6", "C7")

``requirements`` says what is asked, ``candidates`` and ``cover`` find the fewest layers, ``certificate`` why there
are no fewer, ``assignment`` judges any answer, ``dropping`` what to give up. ``slots``, ``grouping``, ``existing``,
``binding`` and ``world_planning`` do it for the files of a Flatland world, which ``patch`` alone writes. ``drawing``,
``graphs``, ``explain`` and ``data`` show it. networkx and HiGHS are imported when something is solved, not before.
"""
