"""A commented study file that can be flown as it is."""

TEMPLATE = """\
# A study of tandemlift: many flights in one table. `tandemlift study FILE.toml` flies it, `--dry-run` counts it first.
# Rows are: missions x controllers x engines x cases x grid points x draws x seeds. Omitted keys have their defaults.
# Only [study] with name and missions is required. docs/reference/studies.md explains every table.

[study]
name = "gusts"                  # its folder is out/NAME
missions = ["iris"]             # built-in names, or paths from the folder of this file
controllers = []                # names, or .py files from the folder of this file; empty: each mission's own
engines = ["compiled"]          # see `tandemlift engines`
draws = 40                      # points of [draw]; the same for each grid point, case, controller and mission
sampling = "random"             # random, sobol, latin-hypercube, or saltelli for Sobol' indices of sensitivity
persons = "own"                 # own, or random: gains, arm, speed, lag of the mission's person x 0.7 to 1.3,
                                # delay 0.1 to 0.3 s, tremor up to 0.1 N, any grip, a wind of up to 1 N
seeds = 1                       # flights of each point, with different noise, wind and tremor (mission.seed)
seed = 0                        # of the points, and first mission.seed

[set]                           # the same in every flight; any key of a mission, as in `tandemlift run --set`
wind.model = "air"

[[cases]]                       # named sets of changes; every case is flown with all points
name = "as it is"

[[cases]]
name = "slow rotors"
set.actuators.delay = 0.03

[grid]                          # keys that take each of some values; all combinations are flown
plant.mass_scale = [0.95, 1.0, 1.05]
# admittance.damping = {low = 2.0, high = 8.0, count = 7}                   # evenly spaced; spacing = "log"

[draw]                          # keys that are drawn at random; relative = true multiplies the mission's own value
wind.velocity = {distribution = "horizontal", low = 0.0, high = 4.0}        # [x, y, 0] of any direction
wind.turbulence = {distribution = "log-uniform", low = 0.5, high = 4.0}
plant.inertia_scale = {distribution = "uniform", low = 0.9, high = 1.1, count = 3}  # a list of 3 values
# initial.position = {distribution = "normal", mean = 0.0, deviation = 0.05, low = -0.2, high = 0.2, count = 3}
# person.delay = {distribution = "uniform", low = 0.1, high = 0.3, step = 0.02}      # multiples of step only
# pushes.0.force.0 = {distribution = "choice", among = [1.0, 2.0, 4.0]}
# mission.seed = {distribution = "integer", low = 0, high = 999}

[keep]                          # data of each flight that goes into the table
metrics = []                    # names in metrics.json; empty: all
channels = []                   # channels of some flights, such as ["position", "push_estimate"]:
rows = []                       #   of these rows,
outcomes = ["crashed"]          #   of rows with these outcomes,
every = 100                     #   and of one row in so many
"""
