# Importers that are not part of the tests: how they are built and run. Copy lines from here; it is not run as a whole.

# Debian: apt-get install gcc cmake libxml2-dev libminizip-dev libsundials-dev; in the folders of the sources
# Reference FMUs: fmusim
gcc -w '-DFMUSIM_VERSION="0.0.39"' -DSUN_COMM_NULL=NULL -Ifmusim -Iinclude -I/usr/include/libxml2 -I/usr/include/minizip \
    fmusim/*.c src/FMI*.c src/structured_variable_name.*.c -o build/fmusim -lxml2 -lminizip -lz \
    -lsundials_cvode -lsundials_nvecserial -lsundials_sunmatrixdense -lsundials_sunlinsoldense -ldl -lm
# FMUComplianceChecker
cmake -S . -B build && cmake --build build
# FMI Library, then PyFMI without its interface to Assimulo (delete it from setup.py; conda has packages with it)
# PyPI has PyFMI only in a version of 2018.
cmake -S . -B build -DFMILIB_INSTALL_PREFIX=$HOME/fmil && cmake --build build && cmake --install build
pip install "cython<3" "numpy<2" scipy lxml setuptools && python setup.py install --fmil-home=$HOME/fmil

# After `cargo xtask importers`, in the project's folder:
cut -d, -f1,2 out/conformance/reference.csv > out/run.csv      # time and base.acceleration
fmusim --interface-type cs --stop-time 0.005 --output-interval 1e-5 --start-value solver.tolerance 1e-7 \
    --input-file out/run.csv --output-variable contact.force --output-file out/fmusim.csv dist/RelayContact.fmu
fmuCheck.linux64 -k cs -h 1e-5 -s 0.005 -n 0 -i out/run.csv -o out/checker.csv dist/RelayContact.fmu
python - <<'PYTHON'
import csv

import pyfmi

contact = pyfmi.load_fmu("dist/RelayContact.fmu", kind="CS")
contact.setup_experiment()
contact.set("solver.tolerance", 1e-7)
contact.initialize()
with open("out/run.csv", newline="") as file:
    accelerations = [float(row["base.acceleration"]) for row in csv.DictReader(file)]
for n, acceleration in enumerate(accelerations):
    contact.set("base.acceleration", acceleration)
    contact.do_step(n * 1e-5, 1e-5, True)
    print(contact.get("contact.force")[0])
PYTHON

# fmi-sim, which takes minutes to compile. Its forces are the bits of the column `run` for the first 253 steps.
export LIBCLANG_PATH=$(.venv/bin/python -c "import clang, pathlib; print(pathlib.Path(clang.__path__[0]) / 'native')")
export BINDGEN_EXTRA_CLANG_ARGS=-I$(cc -print-file-name=include)
cargo install fmi-sim --version 0.7.0 --locked --root target/fmi-sim
target/fmi-sim/bin/fmi-sim --model dist/RelayContact.fmu --input-file out/conformance/reference.csv --output-file out/fmi-sim.csv \
    co-simulation --output-interval 1e-5 -f 0.005 --init-values solver.tolerance=1e-7
