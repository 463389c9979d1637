"""The parts of a flight: laws, which are pure functions of values, one topic per file, with the paper's labels; the
vehicle, controllers, and the pilot that connects them.

SI units, z up. World axes are inertial, body axes are fixed to the vehicle. Attitude maps body axes to world axes, and
Euler angles (φ, θ, ψ) are Z-X-Y: R = Rz(ψ) Rx(φ) Ry(θ). docs/reference/equation-map.md maps every label to a law.
"""
