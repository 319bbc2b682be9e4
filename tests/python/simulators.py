"""Models that left Trimtab, simulated by FMPy, Octave and JSBSim, against Trimtab's own simulation: see tests/python/simulators."""
import csv
import ctypes
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

PROGRAM, WORK = os.environ["TRIMTAB_PROGRAM"], Path(sys.argv[1])
FOOT, POUND = 0.3048, 4.4482216152605


def trimtab(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def table(file):
    """Columns by name without unit, in SI (deg to rad)."""
    rows = [row for row in csv.reader(line for line in open(file) if not line.startswith("#"))]
    columns = {}
    for place, title in enumerate(rows[0]):
        name, _, unit = title.partition("[")
        scale = math.pi / 180 if unit.startswith("deg") else 1.0
        columns[name.strip()] = scale * np.array([float(row[place]) for row in rows[1:]])
    return columns


def agree(what, found, expected, within):
    off = np.abs(found - expected).max() / np.abs(expected).max()
    print(f"{what:58} {off:.1e} of the largest value (at most {within:.0e})")
    assert off <= within, what


def exported(model, recording, options, *files):
    """Writes files of the model fitted to a recording; the fit's outputs of the model along it."""
    arguments = [recording, "--model", model, *options]
    for file in files:
        trimtab("linear", *arguments, "--simulator-model" if file.suffix in (".fmu", ".xml") else "--source-code", file)
    fit = WORK / "fit.json"
    fit.write_text(trimtab("fit", *arguments, "--json"))
    return json.loads(fit.read_text())


def outputs(fit):
    history = (fit.get("histories") or fit.get("time_histories"))[0]
    return np.array(history["time"]), {one["name"]: np.array(one["model"]) for one in history["outputs"]}


def fmpy_and_octave():
    from fmpy import read_model_description, simulate_fmu, extract
    from fmpy.build import build_platform_binary
    from fmpy.validation import validate_fmu
    recording = "data/elevator.csv"
    unit, source = WORK / "short_period.fmu", WORK / "short_period.m"
    fit = exported("short-period", recording, [], unit, source)
    assert validate_fmu(str(unit)) == [], validate_fmu(str(unit))
    description = read_model_description(str(unit))
    folder = extract(str(unit))
    build_platform_binary(folder, all_warnings=True)
    time, expected = outputs(fit)
    time = time - time[0]
    de = table(recording)["de"]
    signals = np.array(list(zip(time, de)), dtype=[("time", float), ("de", float)])
    step = float(time[1] - time[0])
    # model exchange: classical Runge-Kutta steps of our own by the functions of the standard, since simulate_fmu holds inputs
    from fmpy.fmi2 import FMU2Model, FMU2Slave
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    model = FMU2Model(guid=description.guid, unzipDirectory=folder, modelIdentifier=description.modelExchange.modelIdentifier)
    model.instantiate()
    model.setupExperiment(startTime=0.0)
    model.enterInitializationMode()
    model.exitInitializationMode()
    model.enterContinuousTimeMode()
    x, dx = (ctypes.c_double * 2)(), (ctypes.c_double * 2)()
    model.getContinuousStates(x, 2)
    states = np.array(x)

    def rate(states, t, u):
        model.setTime(t)
        model.setReal([reference["de"]], [u])
        model.setContinuousStates((ctypes.c_double * 2)(*states), 2)
        model.getDerivatives(dx, 2)
        return np.array(dx)

    rows = []
    for k in range(len(time)):
        rate(states, time[k], de[k])
        rows.append(model.getReal([reference["alpha"], reference["q"]]))
        if k + 1 < len(time):
            middle, t = 0.5 * (de[k] + de[k + 1]), time[k]
            k1 = rate(states, t, de[k])
            k2 = rate(states + step / 2 * k1, t + step / 2, middle)
            k3 = rate(states + step / 2 * k2, t + step / 2, middle)
            k4 = rate(states + step * k3, t + step, de[k + 1])
            states = states + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    model.terminate()
    model.freeInstance()
    for place, name in enumerate(["alpha", "q"]):
        agree(f"FMPy, model exchange: {name}", np.array(rows)[:, place], expected[name], 1e-7)

    # inputs straight in co-simulation: by the functions of the standard, since simulate_fmu sets derivatives of nine inputs or none
    unit2 = FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=description.coSimulation.modelIdentifier)
    unit2.instantiate()
    unit2.setupExperiment(startTime=0.0)
    unit2.enterInitializationMode()
    unit2.setReal([reference["de"]], [de[0]])
    unit2.exitInitializationMode()
    rows = []
    for k in range(len(time)):
        unit2.setReal([reference["de"]], [de[k]])
        rows.append(unit2.getReal([reference["alpha"], reference["q"]]))
        if k + 1 < len(time):
            values = [(ctypes.c_uint32 * 1)(reference["de"]), 1, (ctypes.c_int * 1)(1), (ctypes.c_double * 1)((de[k + 1] - de[k]) / step)]
            unit2.fmi2SetRealInputDerivatives(unit2.component, *values)
            unit2.doStep(currentCommunicationPoint=time[k], communicationStepSize=step)
    unit2.terminate()
    unit2.freeInstance()
    for place, name in enumerate(["alpha", "q"]):
        agree(f"FMPy, co-simulation, inputs straight: {name}", np.array(rows)[:, place], expected[name], 1e-7)
    held = outputs(exported("short-period", recording, ["--hold"], unit))[1]
    folder = extract(str(unit))
    build_platform_binary(folder)
    description = read_model_description(str(unit))
    result = simulate_fmu(folder, model_description=description, stop_time=time[-1], input=signals, output=["alpha", "q"],
                          fmi_type="CoSimulation", output_interval=step)
    for name, y in held.items():
        agree(f"FMPy, co-simulation, inputs held: {name}", np.interp(time, result["time"], result[name]), y, 1e-6)
    start = {row["name"]: row["estimate"] for row in fit["estimate"]["parameters"]}
    changed = simulate_fmu(folder, model_description=description, stop_time=time[-1], input=signals, output=["alpha"],
                           output_interval=step, start_values={"Ma": 1.5 * start["Ma"]})
    assert np.abs(changed["alpha"] - result["alpha"]).max() > 1e-3, "a parameter changes the response"

    # MATLAB's language, by Octave: the same steps as Trimtab's
    inputs = WORK / "inputs.txt"
    np.savetxt(inputs, de, fmt="%.17g")
    script = f"""
        u = load('{inputs}'); h = {step!r}; [~, ~, x] = short_period();
        y = zeros(numel(u), 2);
        for k = 1:numel(u)
          if k > 1
            a = u(k - 1); b = u(k); m = (a + b)/2; t = (k - 2)*h;
            k1 = short_period(x, a, t); k2 = short_period(x + h/2*k1, m, t + h/2);
            k3 = short_period(x + h/2*k2, m, t + h/2); k4 = short_period(x + h*k3, b, t + h);
            x = x + h/6*(k1 + 2*k2 + 2*k3 + k4);
          end
          [~, now] = short_period(x, u(k), (k - 1)*h); y(k, :) = now';
        end
        printf('%.17g %.17g\\n', y');
        [dx, y, x0] = short_period(); assert(isequal(size(dx), [2 1]) && isequal(size(x0), [2 1]));
    """
    done = subprocess.run(["octave-cli", "--quiet", "--path", str(WORK), "--eval", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = np.array([[float(cell) for cell in line.split()] for line in done.stdout.split("\n") if line])
    for place, name in enumerate(["alpha", "q"]):
        agree(f"Octave: {name}", rows[:, place], expected[name], 1e-9)


AIRCRAFT = """<?xml version="1.0"?>
<fdm_config name="navion" version="2.0">
 <metrics>
  <wingarea unit="M2"> 17.094 </wingarea> <wingspan unit="M"> 10.18 </wingspan> <chord unit="M"> 1.737 </chord>
  <location name="AERORP" unit="M"> <x> 0 </x> <y> 0 </y> <z> 0 </z> </location>
 </metrics>
 <mass_balance>
  <ixx unit="KG*M2"> 1420.9 </ixx> <iyy unit="KG*M2"> 4067.5 </iyy> <izz unit="KG*M2"> 4786.0 </izz>
  <emptywt unit="KG"> 1247.4 </emptywt>
  <location name="CG" unit="M"> <x> 0 </x> <y> 0 </y> <z> 0 </z> </location>
 </mass_balance>
 <ground_reactions/>
 <external_reactions>
  <force name="thrust" frame="BODY">
   <location unit="M"> <x> 0 </x> <y> 0 </y> <z> 0 </z> </location> <direction> <x> 1 </x> <y> 0 </y> <z> 0 </z> </direction>
  </force>
 </external_reactions>
 <flight_control name="none"/>
 <aerodynamics file="aero"/>
</fdm_config>
"""


def jsbsim():
    import jsbsim
    recording = WORK / "six.csv"
    trimtab("simulate", "tests/numbers/catalog/six-degrees-of-freedom.toml", "-o", recording)
    folder = WORK / "aircraft" / "navion"
    folder.mkdir(parents=True)
    options = ["--max-iterations", "8"]
    fit = exported("six-degrees-of-freedom", recording, options, folder / "aero.xml")
    (folder / "navion.xml").write_text(AIRCRAFT)
    p = {row["name"]: row["estimate"] for row in fit["estimate"]["parameters"]}
    jsbsim.FGJSBBase().debug_lvl = 0
    fdm = jsbsim.FGFDMExec(str(WORK))
    fdm.set_debug_level(0)
    assert fdm.load_model("navion")

    # forces and moments at states without structure
    random = np.random.default_rng(1)
    worst = 0.0
    for _ in range(50):
        alpha, beta, v = random.uniform(-0.15, 0.25), random.uniform(-0.15, 0.15), random.uniform(40, 80)
        rates = random.uniform(-0.4, 0.4, 3)
        fdm["ic/h-sl-ft"] = 500.0
        fdm["ic/vt-fps"], fdm["ic/alpha-rad"], fdm["ic/beta-rad"] = v / FOOT, alpha, beta
        fdm["ic/p-rad_sec"], fdm["ic/q-rad_sec"], fdm["ic/r-rad_sec"] = rates
        deflections = random.uniform(-0.2, 0.2, 3)
        for name, angle in zip(["elevator", "left-aileron", "rudder"], deflections):
            fdm[f"fcs/{name}-pos-rad"] = angle
        assert fdm.run_ic()
        for name, angle in zip(["elevator", "left-aileron", "rudder"], deflections):
            fdm[f"fcs/{name}-pos-rad"] = angle
        fdm.disable_output()
        fdm.suspend_integration()
        fdm.run()
        fdm.resume_integration()
        de, da, dr = (fdm[f"fcs/{name}-pos-rad"] for name in ["elevator", "left-aileron", "rudder"])
        alpha, beta, v = fdm["aero/alpha-rad"], fdm["aero/beta-rad"], fdm["velocities/vt-fps"] * FOOT
        ph, qh, rh = (fdm[f"velocities/{n}-aero-rad_sec"] * x / (2 * v) for n, x in zip("pqr", (10.18, 1.737, 10.18)))
        force = fdm["aero/qbar-psf"] * POUND / FOOT**2 * 17.094
        lateral = lambda a: sum(p[a + d] * x for d, x in zip(["0", "b", "p", "r", "da", "dr"], [1, beta, ph, rh, da, dr]))
        expected = {
            "forces/fbx-aero-lbs": force * (p["Cx0"] + p["Cxa"] * alpha) / POUND,
            "forces/fby-aero-lbs": force * lateral("Cy") / POUND,
            "forces/fbz-aero-lbs": force * (p["Cz0"] + p["Cza"] * alpha + p["Czq"] * qh + p["Czde"] * de) / POUND,
            "moments/l-aero-lbsft": force * 10.18 * lateral("Cl") / POUND / FOOT,
            "moments/m-aero-lbsft": force * 1.737 * (p["Cm0"] + p["Cma"] * alpha + p["Cmq"] * qh + p["Cmde"] * de) / POUND / FOOT,
            "moments/n-aero-lbsft": force * 10.18 * lateral("Cn") / POUND / FOOT,
        }
        for name, value in expected.items():
            worst = max(worst, abs(fdm[name] - value) / (1 + abs(value)))
    print(f"{'JSBSim: forces and moments at 50 states':58} {worst:.1e} of each (at most 1e-06)")
    assert worst < 1e-6

    # the flight: JSBSim's round Earth and its air that thins with altitude against a flat one with constant air
    flown = table(recording)
    time, expected = outputs(fit)
    first = {name: y[0] for name, y in expected.items()}
    step = 0.001
    fdm = jsbsim.FGFDMExec(str(WORK))
    fdm.set_debug_level(0)
    assert fdm.load_model("navion")
    fdm.set_dt(step)
    fdm["ic/h-sl-ft"], fdm["ic/lat-geod-deg"] = 0.0, 45.0
    fdm["ic/vt-fps"], fdm["ic/alpha-rad"], fdm["ic/beta-rad"] = first["V"] / FOOT, first["alpha"], first["beta"]
    fdm["ic/phi-rad"], fdm["ic/theta-rad"], fdm["ic/psi-true-rad"] = first["phi"], first["theta"], first["psi"]
    fdm["ic/p-rad_sec"], fdm["ic/q-rad_sec"], fdm["ic/r-rad_sec"] = first["p"], first["q"], first["r"]
    def controls(t):
        fdm["fcs/elevator-pos-rad"] = np.interp(t, time, flown["de"])
        fdm["fcs/left-aileron-pos-rad"] = np.interp(t, time, flown["da"])
        fdm["fcs/rudder-pos-rad"] = np.interp(t, time, flown["dr"])
        fdm["external_reactions/thrust/magnitude"] = np.interp(t, time, flown["thrust"]) / POUND
    controls(0.0)
    assert fdm.run_ic()
    names = {"V": ("velocities/vt-fps", FOOT), "alpha": ("aero/alpha-rad", 1), "q": ("velocities/q-rad_sec", 1),
             "p": ("velocities/p-rad_sec", 1), "r": ("velocities/r-rad_sec", 1), "beta": ("aero/beta-rad", 1)}
    seen = {name: [] for name in names}
    for t in time:
        while fdm.get_sim_time() < t - time[0] - step / 2:
            controls(fdm.get_sim_time() + time[0])
            fdm.run()
        for name, (prop, factor) in names.items():
            seen[name].append(fdm[prop] * factor)
    until = time < time[0] + 20.0
    for name in names:
        agree(f"JSBSim, 20 s of flight: {name}", np.array(seen[name])[until], expected[name][until], 0.02)


fmpy_and_octave()
jsbsim()
print("all agree")
