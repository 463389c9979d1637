"""Former names of keys, each with its present one: an unknown key that once was one names its successor."""

from __future__ import annotations

RENAMED = {  # by table: OLD=NEW
    "": "partner=person",
    "mission": "fused=fma",
    "admittance": "reanchor=hold_after_release",
    "compliance": "hearing=input_bandwidth easing=output_bandwidth release=release_fraction forget=bias_time_constant "
    "braking=braking_gain thrust_share=thrust_fraction lead=reference_lead press=touchdown_depth spool=spin_up_time "
    "max_descent=max_descent_speed",
    "compliance.yaw": "leash=max_lead_angle",
    "compliance.tank": "size=capacity low=low_energy refill=refill_fraction fade=fade_time",
    "detection": "forget=bias_bandwidth habit=scatter_bandwidth spread=thrust_uncertainty evidence=threshold "
    "margin=isolation_margin unexplained=unexplained_fraction retest=retest_time",
    "estimator": "least_force=min_force",
    "supervision": "patience=hold_timeout calm=recovery_time deeper=blind_descent_depth touch=touchdown_gap "
    "sinking=blind_descent_acceleration watch=watchdog",
    "supervision.checks": "thrust_share=thrust_fraction payload_least=min_payload_ratio payload_most=max_payload_ratio",
    "supervision.watchdog": "stale=stale_time invalid=invalid_time frozen=frozen_samples force=max_force "
    "torque=max_torque specific_force=max_specific_force rates=max_rates position=max_position velocity=max_velocity "
    "turn_bandwidth=rates_bandwidth way_bandwidth=velocity_bandwidth",
    "supervision.fence": "slowing=braking_gain",
    "supervision.limits": "thrust_share=thrust_fraction error=tracking_error error_time=tracking_error_time",
    "supervision.reactions": "unit=imu joints_apart=joints_inconsistent attitude_apart=attitude_inconsistent "
    "velocity_apart=velocity_inconsistent speed_apart=speed_inconsistent error=tracking_error",
    "person": "approach=approach_gain breakaway=breakaway_force trimming=trim_rate corner=corner_distance "
    "arrive=arrival_radius slow=landing_speed turn_gain=yaw_gain turn_damping=yaw_damping start=start_time "
    "height_share=height_fraction",
}


def present_name(key: str) -> str:
    """The present name of a dotted key without numbers; the same if it or a table of it was never renamed."""
    names = list[str]()
    for part in key.split("."):
        own = dict(one.split("=") for one in RENAMED.get(".".join(names), "").split())
        names.append(own.get(part, part))
    return ".".join(names)
