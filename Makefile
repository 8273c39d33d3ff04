# The front door: `make` alone prints what there is.

SHELL := /bin/bash
.SHELLFLAGS := -e -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory

# What a recipe begins with that builds or runs anything of the workspace:
# - a pyenv or conda python first on PATH breaks catkin and every Python node;
# - another workspace, sourced in the user's shell, is none of this one's business;
# - ROS Noetic proper has a file to source, Debian's ROS has not.
NOETIC := $(wildcard /opt/ros/noetic/setup.bash)
IN_ENVIRONMENT := export PATH=/usr/bin:/bin:/usr/sbin:/sbin:"$$PATH"; \
  unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH PYTHONPATH; $(if $(NOETIC),source $(NOETIC);)
IN_WORKSPACE := cd catkin_ws; $(IN_ENVIRONMENT)

# ROS 1 has no authentication: unless the user says otherwise, listen on this machine only.
LOCAL := if [ -z "$$ROS_IP$$ROS_HOSTNAME" ]; then export ROS_HOSTNAME=localhost; fi;

# The tests bring their own master and talk to this machine alone, whatever the user's shell says.
ALONE := unset ROS_IP ROS_NAMESPACE ROS_MASTER_URI; export ROS_HOSTNAME=localhost; \
  export ROS_LOG_DIR=$(CURDIR)/catkin_ws/build/test_logs;

CATKIN_MAKE := catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=RelWithDebInfo
INSTALL := catkin_ws/tools/install_packages.sh
CHECKER := $(addprefix catkin_ws/apt/,build.txt runtime.txt tools.txt check.txt)
PACKAGES := $(CHECKER) $(addprefix catkin_ws/apt/,view.txt test.txt docs.txt)
BUILT := catkin_ws/devel/.built
RESULTS := $(CURDIR)/catkin_ws/build/test_results
SITE := $(CURDIR)/catkin_ws/build/docs
SCREENSHOTS := $(CURDIR)/catkin_ws/build/screenshots
BENCH := $(CURDIR)/catkin_ws/build/bench
ORIGINAL := $(CURDIR)/catkin_ws/build/original

.PHONY: help
help:  ## print the targets
	@sed -n 's/^\([a-z-]*\):.*##/\1/p' $(MAKEFILE_LIST) | \
	  while read -r target text; do printf '  make %-16s %s\n' "$$target" "$$text"; done

.PHONY: deps
deps:  ## install the Debian packages that building, running and testing need
	@$(INSTALL) $(PACKAGES)

.PHONY: build
build: deps $(BUILT)  ## build the workspace with catkin_make

$(BUILT): $(shell find catkin_ws/src -type f -not -name '*.pyc' -not -path catkin_ws/src/CMakeLists.txt) | deps
	@$(IN_WORKSPACE) $(CATKIN_MAKE)
	@touch $@

.PHONY: run
run: build  ## run the four nodes; end them with Ctrl-C
	@$(IN_WORKSPACE) $(LOCAL) source devel/setup.bash; exec roslaunch mrp pub_sub.launch

.PHONY: test
test: build  ## build, run every test, and print one summary
	@$(INSTALL) catkin_ws/apt/bench.txt
	@rm -rf $(RESULTS)
	@$(IN_WORKSPACE) $(ALONE) $(CATKIN_MAKE) run_tests -j1
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; status=0; \
	/usr/bin/python3 -m pytest -n 3 --junit-xml=$(RESULTS)/workspace.xml tests \
	  --ignore=tests/test_check_sets.py $(addprefix --deselect=,$(DEFECTS)) || status=1; \
	catkin_test_results $(RESULTS) > /dev/null || status=1; \
	tools/test_summary.py $(RESULTS) || status=1; \
	exit $$status

.PHONY: labs
labs:  ## list the labs: each is a launch file that shows one claim
	@for file in catkin_ws/src/mrp_labs/launch/*.launch; do \
	  printf '  %-52s %s\n' "roslaunch mrp_labs $$(basename $$file)" \
	    "$$(sed -n '1s/<!-- \(.*\) -->/\1/p' $$file)"; done

# It builds the package in a folder of its own, so nothing of this workspace need be built before.
.PHONY: check
check:  ## check the package at PKG against the tutorial's contract, or against SPEC
	@test -n "$(PKG)" || { echo "error: expected make check PKG=PATH, the folder of a package" >&2; exit 2; }
	@$(INSTALL) $(CHECKER)
	@$(IN_ENVIRONMENT) PYTHONPATH=catkin_ws/src/mrp_check/src exec /usr/bin/python3 \
	  catkin_ws/src/mrp_check/scripts/check "$(PKG)" $(if $(SPEC),--spec "$(SPEC)")

# More than 150 whole packages are built and run, and dozens of nodes at once: so it is no part of
# `make test`.
DEFECTS := tests/test_check_run.py::test_each_defect_is_found_at_its_place
.PHONY: test-check
test-check: deps  ## check the packages that judge the checker
	@$(IN_WORKSPACE) $(ALONE) \
	/usr/bin/python3 -m pytest -n 3 --junit-xml=$(RESULTS)/check.xml tests/test_check_sets.py $(DEFECTS)

# HINT=1 shows the hint; RESET=1 begins the exercise anew. Exit code 1 only says: not yet.
.PHONY: exercise
exercise:  ## show the next exercise, or check it; HINT=1 gives a hint
	@$(INSTALL) $(CHECKER)
	@$(IN_ENVIRONMENT) PYTHONPATH=catkin_ws/src/mrp_check/src /usr/bin/python3 -m mrp_check.exercise \
	  $(if $(HINT),--hint) $(if $(RESET),--reset) catkin_ws/exercises || [ $$? = 1 ]

# What else runs on this machine shows in the figures: end it before.
.PHONY: bench
bench: build  ## measure how fast nodes are; QUICK=1: less of it; RESUME=1: go on with the last run
	@$(INSTALL) catkin_ws/apt/bench.txt
	@$(if $(QUICK),,$(IN_WORKSPACE) tools/build_original.py $(ORIGINAL) > /dev/null)
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; \
	exec rosrun mrp_bench bench.py $(if $(QUICK),--quick,--beside $(ORIGINAL)) \
	  $(if $(RESUME),--resume) $(BENCH)

.PHONY: bench-record
bench-record:  ## put what `make bench` measured into the pages
	@/usr/bin/python3 catkin_ws/tools/record_bench.py $(BENCH)

# Of the tests it takes the time of the last `make test`, and says so if there was none.
.PHONY: own-times
own-times: deps  ## fail if building and testing take longer than before; RECORD=1: keep the times
	@$(INSTALL) catkin_ws/apt/bench.txt
	@$(IN_WORKSPACE) /usr/bin/python3 tools/own_times.py $(if $(RECORD),record,check)

# The pages that it links to are built once.
.PHONY: view
view: build  ## watch the graph and the messages in a browser; end it with Ctrl-C
	@[ -e $(SITE)/index.html ] || $(MAKE) docs > /dev/null
	@$(IN_WORKSPACE) $(LOCAL) source devel/setup.bash; \
	exec rosrun mrp_view view_node.py --tutorial $(SITE) $(VIEW_OPTIONS)

.PHONY: lint
lint:  ## check the style of all sources
	@$(INSTALL) $(PACKAGES) catkin_ws/apt/lint.txt
	@$(IN_WORKSPACE) tools/lint.sh

# Made anew each time: otherwise Sphinx keeps pages that are no more, and an old style sheet.
.PHONY: docs
docs:  ## build the tutorial's pages
	@$(INSTALL) catkin_ws/apt/docs.txt
	@rm -rf $(SITE)
	@$(IN_WORKSPACE) /usr/bin/python3 -m sphinx -q -W --keep-going -d build/doctrees src/mrp/doc $(SITE)
	@echo "Open file://$(SITE)/index.html"

.PHONY: docs-serve
docs-serve: docs  ## build the pages, and serve them to this machine's browsers
	@exec /usr/bin/python3 catkin_ws/tools/serve.py $(SITE)

.PHONY: docs-record
docs-record: deps  ## do what the pages say, and record what they show of it
	@$(IN_WORKSPACE) /usr/bin/python3 tools/run_page.py record

.PHONY: test-browser
test-browser: build docs  ## open every page in Chromium and in Firefox
	@$(INSTALL) catkin_ws/apt/test.txt catkin_ws/apt/browser.txt
	@rm -rf $(SCREENSHOTS)
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; \
	/usr/bin/python3 -m pytest --junit-xml=$(RESULTS)/browser.xml browser_tests
	@echo "Look at the pages: $(SCREENSHOTS)"

.PHONY: doctor
doctor:  ## find what keeps the tutorial from running on this machine
	@test -x /usr/bin/python3 || { echo "[FAIL] expected /usr/bin/python3; there is none"; \
	  echo "       mend: make deps"; exit 1; }
	@/usr/bin/python3 -I catkin_ws/tools/doctor.py

.PHONY: clean
clean:  ## delete all that was built
	rm -rf catkin_ws/build catkin_ws/devel catkin_ws/install
	rm -f catkin_ws/src/CMakeLists.txt catkin_ws/.catkin_workspace

# Containers. DEBIAN names the release that the images are made of: bookworm (12) or trixie (13).
export DEBIAN ?= bookworm
IMAGE := mrp:$(DEBIAN)
DOCKER_RESULTS := $(RESULTS)/$(DEBIAN)
COMPOSE = $(shell docker compose version > /dev/null 2>&1 && echo docker compose || echo docker-compose)
COMPOSE_MRP = $(COMPOSE) --project-name mrp --file docker/compose.yaml

# The context goes to the builder as a tar stream: so both builders leave out the same.
IMAGE_OF = COPYFILE_DISABLE=1 tar --create --exclude=.git --exclude=__pycache__ --exclude='*_cache' \
  --exclude=catkin_ws/build --exclude=catkin_ws/devel --exclude=catkin_ws/install \
  --exclude=catkin_ws/src/CMakeLists.txt . | \
  docker build $(DOCKER_BUILD_OPTIONS) --build-arg DEBIAN=$(DEBIAN) --file docker/Dockerfile

.PHONY: need-docker
need-docker:
	@command -v docker > /dev/null || { \
	  echo "error: this needs Docker, which is not installed on this machine" >&2; exit 1; }
	@docker info > /dev/null 2>&1 || { \
	  echo "error: Docker's engine does not answer: start it; 'docker info' says more" >&2; exit 1; }

.PHONY: docker-build
docker-build: need-docker  ## build the image mrp, which runs the four nodes anywhere
	$(IMAGE_OF) --target runtime --tag $(IMAGE) -

.PHONY: docker-size
docker-size: docker-build  ## fail if the image mrp is larger than before; RECORD=1: keep its size
	@/usr/bin/python3 catkin_ws/tools/image_size.py $(if $(RECORD),record,check) $(IMAGE)

.PHONY: docker-build-ssh
docker-build-ssh: docker-build  ## build the image for docker/several_hosts/remote.yaml
	$(IMAGE_OF) --target ssh --tag mrp-ssh:$(DEBIAN) -

.PHONY: docker-build-view
docker-build-view: docker-build
	$(IMAGE_OF) --target view --tag mrp-view:$(DEBIAN) -

# Without a network: ROS 1 has no authentication, and the nodes talk to one another alone.
.PHONY: docker-run
docker-run: docker-build  ## run the four nodes in a container; end them with Ctrl-C
	@exec docker run --rm --name mrp --network none $(IMAGE)

.PHONY: docker-up
docker-up: docker-build  ## run one container per node; end them with Ctrl-C
	@$(COMPOSE_MRP) up

.PHONY: docker-view
docker-view: docker-build-view  ## as docker-up, with the live page at http://127.0.0.1:8765/
	@$(COMPOSE_MRP) --profile view up

.PHONY: docker-down
docker-down: need-docker  ## take away what docker-up or docker-view leaves
	@$(COMPOSE_MRP) --profile view down

.PHONY: docker-test
docker-test: docker-suite docker-containers  ## run every test in a container, and test the containers

# The suite of `make test`, in a container without a network. Its name is one that it can resolve,
# which roswtf asks for. Some tests make processes without end: the engine, too, sees to it that they
# stay few.
.PHONY: docker-suite
docker-suite: need-docker
	$(IMAGE_OF) --target test --tag mrp-test:$(DEBIAN) -
	@rm -rf $(DOCKER_RESULTS)/suite; mkdir -p $(DOCKER_RESULTS)/suite
	docker run --rm --init --network none --hostname localhost --pids-limit 4000 \
	  --user "$$(id -u):$$(id -g)" --volume $(DOCKER_RESULTS)/suite:/results mrp-test:$(DEBIAN)

# What the checker needs is in the image of the tests. The package is read alone; nothing that it does
# reaches this machine, which the engine's own limits see to, too.
.PHONY: docker-check
docker-check: need-docker  ## check the package at PKG in a container without a network
	@test -e "$(PKG)/package.xml" || { \
	  echo "error: expected PKG=PATH, the folder of a package; '$(PKG)' has no package.xml" >&2; exit 2; }
	$(IMAGE_OF) --target test --tag mrp-test:$(DEBIAN) -
	@docker run --rm --init --network none --hostname localhost --cap-drop ALL \
	  --security-opt no-new-privileges --memory 4g --pids-limit 1000 \
	  --user "$$(id -u):$$(id -g)" --volume "$(abspath $(PKG)):/package:ro" \
	  --env PYTHONPATH=catkin_ws/src/mrp_check/src mrp-test:$(DEBIAN) \
	  /usr/bin/python3 catkin_ws/src/mrp_check/scripts/check /package

.PHONY: docker-containers
docker-containers: docker-build-ssh
	@/usr/bin/python3 -c 'import pytest' 2> /dev/null || $(INSTALL) <(echo python3-pytest)
	@/usr/bin/python3 -m pytest --junit-xml=$(DOCKER_RESULTS)/containers.xml docker/test
