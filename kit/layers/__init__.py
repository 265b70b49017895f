"""The layer planner: from required contacts and laser views to the fewest collision layers, with a proof.

    case = EXAMPLES["slides-lasers"]              requirements.LayerCase: entities, contacts, lasers
    run = run_greedy(case)                        the slides' method, every step with the choices it had
    plan = solve_layers(case)                     planning.LayerPlan: the optimum, its certificate, or bound and gap
    plan.assignment.layers_of("M2")               ("C3", "C5", "C6", "C7")

``requirements`` says what is asked, ``candidates`` and ``cover`` find the fewest layers, ``planning`` proves that there
are no fewer and finds requirements to drop, ``assignment`` checks any answer. ``flatland`` plans for the files of a
Flatland world, which ``flatland.world_patch`` alone writes. ``drawing``, ``explain``, ``guided_tour`` and
``plan_data`` present it. networkx and HiGHS are imported when something is solved, not before.
"""
