"""Short scenes that together run each schedule, precision, kind of grain and carrier: changes of `bed.toml` by name."""

OFF = False  # in a preset: this table is left out
WET = {  # no grains but water, which is rocked and breaks
    "grains": OFF,
    "material": OFF,
    "water": {"depth": "20 mm", "spacing": "2 mm"},
    "gauges.side": {"place": ["-30 mm", "15 mm"]},
    "gauges.level": {"kind": "level", "y": "-25 mm"},
    "run.repeats": 1,
}

SCENES = {
    "haff-werner": {},
    "mindlin": {"contact.tangential": "mindlin", "contact.rolling": "elastic-plastic"},
    "swayed-linear": {
        "motion.roll": OFF,
        "motion.sway": {"amplitude": "8 mm", "frequency": "3 Hz"},
        "contact.normal": "linear",
        "contact.tangential": "cundall-strack",
    },
    "spill": {"tank.lid": False, "tank.height": "20 mm", "motion.roll.amplitude": "60 deg"},
    "parts": {
        "motion.roll": OFF,
        "parts.gate": {
            "points": [["0 mm", "0.5 mm"], ["0 mm", "49 mm"]],
            "move": ["0 mm", "40 mm"],
            "speed": "0.4 m/s",
            "acceleration": "9 m/s^2",
        },
        "grains.region": [["-29 mm", "0 mm"], ["-1 mm", "0 mm"], ["-1 mm", "49 mm"], ["-29 mm", "49 mm"]],
    },
    "wet-lining": {
        "tank.roughness": "3 mm",
        "contact.cohesion": "humid",
        "material.humidity": "70 %",
        "material.surface_tension": "0.072 N/m",
        "material.contact_angle": "0 deg",
        "material.asperities": "1 nm",
    },
    "bulk": {
        "grains": OFF,
        "material": OFF,
        "bulk": {"density": "850 kg/m^3", "friction": 0.3, "depth": "20 mm", "spacing": "2 mm", "start_friction": 0.4},
        "run.accuracy": "standard",
        "run.repeats": 1,
    },
    "rice": {"grains.count": 40, "shapes.rice": {"cargo": "rice"}, "run.rest": 1e-3},
    "ship": {
        "motion.roll": OFF,
        "grains.count": 120,
        "ship": {
            "breadth": "80 mm",
            "height": "70 mm",
            "draught": "28 mm",
            "gravity_height": "20 mm",
            "roll_period": "0.7 s",
            "hold": ["0 mm", "5 mm"],
            "freedom": "sway-heave-roll",
            "heel": "10 deg",
            "release": "0.1 s",
            "radiation": "memory",
        },
        "waves": {"amplitude": "3 mm", "frequency": "9 rad/s", "soft_start": "0 s"},
        "run.duration": "0.25 s",
    },
    "per-band": {"run.schedule": "per-band", "run.repeats": 1, "run.threads": 2, "grains.count": 120},
    "per-grain-f32": {"run.schedule": "per-grain", "run.precision": "f32"},
    "mixed": {"run.precision": "mixed", "contact.tangential": "mindlin"},
    "gear": {"run.integrator": "gear", "run.duration": "0.05 s"},
    "water": WET,
    "water-mixed": WET | {"run.precision": "mixed", "run.schedule": "per-band", "run.threads": 2},
    "water-air": WET | {"air": {}},
    "water-plate": WET
    | {
        "parts.baffle": {"points": [["10 mm", "0 mm"], ["10 mm", "15 mm"]]},
        "gauges.force": {"kind": "force", "place": ["30 mm", "25 mm"]},
    },
    "water-sources": WET | {"water.scheme": "as_P"},
    "ballast": {
        "motion.roll": OFF,
        "grains.count": 60,
        "water.spacing": "3 mm",
        "tanks.roof": {
            "width": "60 mm",
            "height": "18 mm",
            "depth": "9 mm",
            "place": ["0 mm", "58 mm"],
        },
        "ship": {
            "breadth": "80 mm",
            "height": "80 mm",
            "draught": "34 mm",
            "gravity_height": "20 mm",
            "roll_period": "0.7 s",
            "hold": ["0 mm", "5 mm"],
            "freedom": "sway-heave-roll",
            "heel": "8 deg",
            "release": "0.1 s",
            "radiation": "memory",
        },
        "run.repeats": 1,
        "run.duration": "0.2 s",
    },
    "soaked": {"water": {"depth": "20 mm", "spacing": "6 mm"}, "motion.roll.amplitude": "8 deg", "run.repeats": 1},
    "floating": {  # a hull with grains in her hold, which floods beside it
        "motion.roll": OFF,
        "tank": {"width": "240 mm", "height": "110 mm", "thickness": "3 mm"},
        "water": {"depth": "60 mm", "spacing": "3 mm"},
        "parts.barge": {
            "closed": True,
            "wall": "4 mm",
            "density": "1200 kg/m^3",
            "points": [["-45 mm", "40 mm"], ["45 mm", "40 mm"], ["45 mm", "100 mm"], ["-45 mm", "100 mm"]],
            "rooms": {
                "hold": {"points": [["-15 mm", "44 mm"], ["41 mm", "44 mm"], ["41 mm", "96 mm"], ["-15 mm", "96 mm"]]},
                "wing": {
                    "points": [["-41 mm", "44 mm"], ["-19 mm", "44 mm"], ["-19 mm", "96 mm"], ["-41 mm", "96 mm"]]
                },
            },
            "openings": {"hole": {"points": [["-36 mm", "42 mm"], ["-24 mm", "42 mm"]], "opens": "0.02 s"}},
        },
        "grains.room": "barge.hold",
        "grains.count": 40,
        "run.repeats": 1,
    },
}
