"""The layer planner: who must touch and who must be seen by which laser -> the fewest collision layers.

    case = reading.read_case(Path("yard.layers.yaml"))     the requirements (requirements.py)
    run = greedy.greedy(case)                               the slides' method, step by step
    plan = planning.solve(case)                             the optimum, with its certificate
    plan.assignment.layers_of("robot")                      ("C1", "L1")

Pure but for ``reading``, ``existing`` (Flatland worlds) and ``patch`` (which alone writes files). networkx and HiGHS are
imported when something is solved, not before.
"""
