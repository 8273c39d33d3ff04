# The front door: `make` alone prints what there is for a learner, and `make ALL=1` the rest, too.

SHELL := /bin/bash
.SHELLFLAGS := -e -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory

# What a recipe begins with that builds or runs anything of the workspace:
# - a pyenv or conda python first on PATH breaks catkin and every Python node;
# - another workspace, sourced in the user's shell, is none of this one's business;
# - Debian 14's CMake 4 refuses catkin's own files, unless this variable lets it treat them as 3.5;
# - ROS One and ROS Noetic have a file to source, Debian's ROS has not;
# - in a test, mrp_testing/guard.py puts programs in the place of sudo and its like.
export MRP_OPT_ROS ?= /opt/ros
OPT_ROS := $(firstword $(wildcard $(MRP_OPT_ROS)/one/setup.bash $(MRP_OPT_ROS)/noetic/setup.bash))
IN_ENVIRONMENT := export CMAKE_POLICY_VERSION_MINIMUM=3.5 \
  PATH="$${MRP_TEST_GUARD:+$$MRP_TEST_GUARD:}/usr/bin:/bin:/usr/sbin:/sbin:$$PATH"; \
  unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH PYTHONPATH; $(if $(OPT_ROS),source $(OPT_ROS);)
IN_WORKSPACE := cd catkin_ws; $(IN_ENVIRONMENT)

# What the tests share serves two tools, too, which run where nothing is built.
WITH_TESTING := PYTHONPATH=src/mrp_testing/src

# With ccache, the tests' workspaces get what was compiled here.
CACHE := $(WITH_TESTING) /usr/bin/python3 -m mrp_testing.compiler_cache

# ROS 1 has no authentication: unless the user says otherwise, listen on this machine only.
LOCAL := if [ -z "$$ROS_IP$$ROS_HOSTNAME" ]; then export ROS_HOSTNAME=localhost; fi;

# The tests bring their own master and talk to this machine alone, whatever the user's shell says; and
# nothing is written into the user's home.
ALONE := unset ROS_IP ROS_NAMESPACE ROS_MASTER_URI; export ROS_HOSTNAME=localhost; \
  export ROS_LOG_DIR=$(CURDIR)/catkin_ws/build/test_logs ROS_HOME=$(CURDIR)/catkin_ws/build/ros_home \
  XDG_CACHE_HOME=$(CURDIR)/catkin_ws/build/cache;

# The lists of Debian packages, in catkin_ws/apt, that each target installs when it is first called.
PACKAGES_run := run tools
PACKAGES_build := $(PACKAGES_run) build
PACKAGES_lab := $(PACKAGES_run) labs
PACKAGES_check := $(PACKAGES_run) check
PACKAGES_learn := $(PACKAGES_check) learn
PACKAGES_view := $(PACKAGES_run) view
PACKAGES_test := $(PACKAGES_build) check learn view bench test
PACKAGES_test-all := $(PACKAGES_test) docs cluster test-all
PACKAGES_test-browser := $(PACKAGES_build) view check docs test browser
PACKAGES_bench := $(PACKAGES_build) bench
PACKAGES_docs := docs
PACKAGES_deb := $(PACKAGES_build) deb
PACKAGES_lint := $(PACKAGES_test-all) lint
PACKAGES_release := release

# `make run` builds only the tutorial, and `make lab` adds the labs. What has been built stays built. With -j,
# catkin_make does not add -l: a machine that was busy a minute ago would build one file at a time.
CATKIN_MAKE := catkin_make -j$(shell nproc) -DPYTHON_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
TUTORIAL := -DCATKIN_WHITELIST_PACKAGES=mrp -DCATKIN_ENABLE_TESTING=OFF
LABS := "-DCATKIN_WHITELIST_PACKAGES=mrp;mrp_labs" -DCATKIN_ENABLE_TESTING=OFF
WHOLE := -DCATKIN_WHITELIST_PACKAGES= -DCATKIN_ENABLE_TESTING=ON
# What an editor reads: how each C++ file is compiled.
FOR_EDITORS := ln -sf build/compile_commands.json .
BUILT_TUTORIAL := catkin_ws/devel/.built_tutorial
BUILT_LABS := catkin_ws/devel/.built_labs
BUILT_WHOLE := catkin_ws/devel/.built_whole
sources = $(shell find $(1) -type f -not -name '*.pyc' -not -path '*/doc/*' -not -path catkin_ws/src/CMakeLists.txt 2> /dev/null)

RESULTS := $(CURDIR)/catkin_ws/build/test_results
SITE := $(CURDIR)/catkin_ws/build/docs
SCREENSHOTS := $(CURDIR)/catkin_ws/build/screenshots
BENCH := $(CURDIR)/catkin_ws/build/bench

# A target's prerequisites are made in their order: the packages first.
.NOTPARALLEL:

# A learner's targets fit on a small terminal.
.PHONY: help
help:
	@awk -F ':.*## ' '/^##@ Work/ && "$(ALL)" == "" { exit } /^##@/ { print substr($$0, 5) } \
	  /^[a-z-]+:.*## / { printf "  make %-16s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@$(if $(ALL),,echo 'To work on mrp itself, and to use containers: make ALL=1')

packages-%:
	@catkin_ws/tools/install_packages.sh $(PACKAGES_$*:%=catkin_ws/apt/%.txt)

##@ Start here

# Without root it calls itself again, where the packages are or in a container.
.PHONY: run
ifdef ROOTLESS
run: ; @unset MAKEFLAGS ROOTLESS; exec catkin_ws/tools/rootless.sh $(PACKAGES_run:%=catkin_ws/apt/%.txt)
else
run: packages-run $(BUILT_TUTORIAL)  ## run the four nodes; end them with Ctrl-C; ROOTLESS=1: without root
	@$(IN_WORKSPACE) $(LOCAL) source devel/setup.bash; exec roslaunch mrp pub_sub.launch
endif

# It has no C++ and no messages of its own, so it runs from its sources. It links to the pages, once
# `make docs` has built them.
.PHONY: view
view: packages-view $(BUILT_TUTORIAL)  ## watch the graph and the messages in a browser; end it with Ctrl-C
	@$(IN_WORKSPACE) $(LOCAL) source devel/setup.bash; export PYTHONPATH=src/mrp_view/src:"$$PYTHONPATH"; \
	exec /usr/bin/python3 src/mrp_view/src/view_node.py --tutorial $(SITE) $(VIEW_OPTIONS)

.PHONY: doctor
doctor:  ## find what keeps the tutorial from running on this machine
	@test -x /usr/bin/python3 || { echo "[FAIL] expected /usr/bin/python3; there is none"; \
	  echo "       fix: make deps"; exit 1; }
	@/usr/bin/python3 -IB catkin_ws/tools/doctor.py

# A text may have quotes, and $(...) of a launch file, which make must not read.
.PHONY: why
unexport TEXT
why: export WHY = $(value TEXT)
why:  ## say what an error text means, and how to fix it: paste it, pipe it in, or TEXT="..."
	@/usr/bin/python3 catkin_ws/tools/why.py "$$WHY" || [ $$? = 1 ]

##@ Learn

# From scratch each time: otherwise Sphinx keeps deleted pages, and warns of a page only once.
.PHONY: docs
docs: packages-docs  ## build the tutorial's pages
	@rm -rf $(SITE)
	@$(IN_WORKSPACE) python=$$(tools/docs_env.sh); "$$python" -m sphinx -q -E -W --keep-going -d build/doctrees src/mrp/doc $(SITE)
	@echo "Open file://$(SITE)/index.html"

.PHONY: docs-serve
docs-serve: docs  ## build the pages, and serve them to this machine's browsers
	@exec /usr/bin/python3 -u -m http.server --bind 127.0.0.1 --directory $(SITE) 0 2> /dev/null

.PHONY: labs
labs: packages-lab  ## list ten labs to start with, small demos of one fact each; ALL=1: all of them
	@/usr/bin/python3 catkin_ws/tools/lab.py --list $(if $(ALL),--all)

# It looks up the name before it builds anything.
.PHONY: lab
lab: packages-lab known-lab $(BUILT_LABS)  ## run a lab, NAME=latch: it says what to look for, marks it, and ends
	@$(IN_WORKSPACE) $(LOCAL) source devel/setup.bash; exec tools/lab.py "$(NAME)"

.PHONY: known-lab
known-lab:
	@/usr/bin/python3 catkin_ws/tools/lab.py --check "$(NAME)"

# On a terminal it fills the screen, and elsewhere it prints lines.
.PHONY: learn
learn: packages-learn  ## show one exercise after the other, and check each when you save it
	@$(IN_ENVIRONMENT) PYTHONPATH=catkin_ws/src/mrp_check/src exec /usr/bin/python3 \
	  -m mrp_check.cli.learn catkin_ws/exercises

# HINT=1 shows the hint; RESET=1 starts the exercise again. Exit code 1 only says: not yet.
.PHONY: exercise
exercise: packages-check  ## show the next exercise, or check it; HINT=1 gives a hint
	@$(IN_ENVIRONMENT) PYTHONPATH=catkin_ws/src/mrp_check/src /usr/bin/python3 -m mrp_check.cli.learn --once \
	  $(if $(HINT),--hint) $(if $(RESET),--reset) catkin_ws/exercises || [ $$? = 1 ]

##@ Your own package

# LANGUAGE on the command line only: as a variable of the environment, it is the desktop's own.
.PHONY: new
new:  ## write a package of your own to start from, PKG=~/catkin_ws/src/laser_filter; LANGUAGE=cpp or both
	@/usr/bin/python3 catkin_ws/tools/new_package.py "$(PKG)" \
	  $(if $(findstring command,$(origin LANGUAGE)),"--language=$(LANGUAGE)")

# It builds the package in a folder of its own, so nothing of this workspace need be built before.
.PHONY: check
check: packages-check  ## check your package, PKG=path; ANY=1: any other ROS package; SPEC=FILE: another contract; ALL=1: notes, too
	@test -n "$(PKG)" || { echo "error: expected make check PKG=PATH, the folder of a package" >&2; exit 2; }
	@$(IN_ENVIRONMENT) PYTHONPATH=catkin_ws/src/mrp_check/src exec /usr/bin/python3 \
	  catkin_ws/src/mrp_check/scripts/check "$(PKG)" $(if $(ANY),--any) $(if $(ALL),--all) $(if $(SPEC),--spec "$(SPEC)")

##@ Work on mrp itself

.PHONY: deps
deps: packages-build  ## install the Debian packages that building and running need

.PHONY: build
build: packages-build $(BUILT_WHOLE)  ## build the whole workspace with catkin_make

$(BUILT_WHOLE): $(call sources,catkin_ws/src)
	@$(IN_WORKSPACE) env $$($(CACHE)) $(CATKIN_MAKE) $(WHOLE); $(FOR_EDITORS)
	@touch $@ $(BUILT_TUTORIAL) $(BUILT_LABS)

$(BUILT_LABS): $(call sources,catkin_ws/src/mrp) $(call sources,catkin_ws/src/mrp_labs)
	@$(if $(wildcard $@),,echo "Building the labs: that takes a minute or two, this time only ...")
	@$(IN_WORKSPACE) $(CATKIN_MAKE) $(if $(wildcard $(BUILT_WHOLE)),$(WHOLE),$(LABS)); $(FOR_EDITORS)
	@touch $@ $(BUILT_TUTORIAL)

$(BUILT_TUTORIAL): $(call sources,catkin_ws/src/mrp)
	@$(IN_WORKSPACE) $(CATKIN_MAKE) \
	$(if $(wildcard $(BUILT_WHOLE)),$(WHOLE),$(if $(wildcard $(BUILT_LABS)),$(LABS),$(TUTORIAL))); \
	$(FOR_EDITORS)
	@touch $@

.PHONY: test
test: packages-test $(BUILT_WHOLE)  ## build, run the tests that matter most, and print one summary
	@rm -rf $(RESULTS)
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; tools/run_tests.sh quick

.PHONY: test-all
test-all: test test-rest  ## run every test

# Its summary is that of all: what `make test` left is still there.
.PHONY: test-rest
test-rest: packages-test-all $(BUILT_WHOLE)  ## run the tests that make test leaves out
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; tools/run_tests.sh slow

# More than 150 whole packages are built and run, and dozens of nodes at once: so it is no part of
# `make test-all`.
.PHONY: test-check
test-check: packages-test-all  ## run the checker on its own test packages; TESTS=NAME: those of a name
	@$(IN_WORKSPACE) $(ALONE) /usr/bin/python3 -m pytest -n 3 --dist loadgroup -m sets $(if $(TESTS),-k "$(TESTS)") --junit-xml=$(RESULTS)/sets.xml src/mrp_check/test

.PHONY: test-browser
test-browser: packages-test-browser $(BUILT_WHOLE) docs  ## open every page in Chromium and in Firefox
	@catkin_ws/tools/install_others.sh
	@rm -rf $(SCREENSHOTS)
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; \
	/usr/bin/python3 -m pytest -n 2 --dist loadgroup --junit-xml=$(RESULTS)/browser.xml tests/browser
	@echo "Look at the pages: $(SCREENSHOTS)"

.PHONY: lint
lint: packages-lint $(BUILT_TUTORIAL)  ## check the style of all sources
	@$(IN_WORKSPACE) tools/lint.sh

.PHONY: docs-record
docs-record: packages-test-all  ## do what the pages say, and record what they show; PAGE=latch: of one page
	@$(IN_WORKSPACE) $(WITH_TESTING) /usr/bin/python3 tools/record_pages.py $(PAGE)

# What else runs on this machine shows in the figures: end it before. The page on speed shows a whole
# run: copy the tables in catkin_ws/build/bench to catkin_ws/src/mrp/doc/recorded/speed.
.PHONY: bench
bench: packages-bench $(BUILT_WHOLE)  ## measure how fast nodes are; QUICK=1: less of it
	@$(IN_WORKSPACE) $(ALONE) source devel/setup.bash; \
	exec rosrun mrp_bench bench.py $(if $(QUICK),--quick) $(BENCH)

.PHONY: deb
deb: packages-deb  ## make Debian packages of the four nodes (mrp) and of the checker (mrp-check)
	@$(IN_ENVIRONMENT) catkin_ws/tools/make_debs.sh catkin_ws/build/debs
	@echo "Install one with: apt install ./catkin_ws/build/debs/NAME.deb"

# The addresses go into each package.xml, from where images, pages and reports take them.
.PHONY: release
release: packages-release  ## tag VERSION=1.2.3 of all packages, to be published by REPOSITORY=https://github.com/OWNER/NAME
	@catkin_ws/tools/release.py "$(VERSION)" "$(REPOSITORY)" $(WEBSITE)

.PHONY: release-dry-run
release-dry-run: need-docker packages-release  ## do in a clone what publishing VERSION at REPOSITORY does, and list what it makes
	@catkin_ws/tools/try_release.sh "$(VERSION)" "$(REPOSITORY)"

.PHONY: release-notes
release-notes:
	@catkin_ws/tools/install_packages.sh catkin_ws/apt/release.txt >&2
	@catkin_ws/tools/release.py --notes

.PHONY: clean
clean:  ## delete all that was built
	rm -rf catkin_ws/build catkin_ws/devel catkin_ws/install
	rm -f catkin_ws/src/CMakeLists.txt catkin_ws/.catkin_workspace catkin_ws/compile_commands.json

##@ In containers

# DEBIAN names the release that the images are made of: trixie (13), bookworm (12) or forky (14).
export DEBIAN ?= trixie
IMAGE := mrp:$(DEBIAN)
DOCKER_RESULTS := $(RESULTS)/$(DEBIAN)
COMPOSE = $(shell docker compose version > /dev/null 2>&1 && echo docker compose || echo docker-compose)
COMPOSE_MRP = $(COMPOSE) --project-name mrp --file docker/compose.yaml

# The context goes to the builder as a tar stream: so both builders leave out the same.
IMAGE_OF = COPYFILE_DISABLE=1 tar --create --exclude=.git --exclude=__pycache__ --exclude='*_cache' \
  --exclude=catkin_ws/build --exclude=catkin_ws/devel --exclude=catkin_ws/install \
  --exclude=catkin_ws/src/CMakeLists.txt . | \
  docker build $(DOCKER_BUILD_OPTIONS) --build-arg DEBIAN=$(DEBIAN) --file docker/Dockerfile \
  $(addprefix --label org.opencontainers.image.,$(LABELS))

# What an image says of itself.
LABELS = licenses=BSD-3-Clause version=$(VERSION) revision=$(shell git rev-parse HEAD 2> /dev/null) \
  source=$(REPOSITORY) url=$(WEBSITE)
of_manifest = $(shell sed -n 's:.*<$(1)>\(.*\)</.*:\1:p' catkin_ws/src/mrp/package.xml)
VERSION ?= $(call of_manifest,version)
REPOSITORY ?= $(call of_manifest,url type="repository")
WEBSITE ?= $(call of_manifest,url type="website")

# The image in which the tests run, and the checker's. What nobody trusts runs in a container that has no
# network, hardly a right, and limits by the engine, too.
CHECK_IMAGE = $(IMAGE_OF) --target check --tag mrp-check:$(DEBIAN) -
TEST_IMAGE = $(IMAGE_OF) --target test --tag mrp-test:$(DEBIAN) -
IN_BOUNDS := docker run --rm --init --network none --hostname localhost \
  --cap-drop ALL $(addprefix --cap-add ,CHOWN DAC_OVERRIDE KILL SETGID SETUID) \
  --security-opt no-new-privileges --memory 4g --pids-limit 1000

.PHONY: need-docker
need-docker:
	@command -v docker > /dev/null || { \
	  echo "error: this needs Docker, which is not installed on this machine" >&2; exit 1; }
	@said=$$(docker ps 2>&1 > /dev/null) || { \
	  echo "error: 'docker ps' says: $${said%%$$'\n'*}" >&2; \
	  [[ "$$said" != *[Cc]"annot connect"* && "$$said" != *"failed to connect"* ]] || \
	    echo "fix: start Docker's engine" >&2; exit 1; }

.PHONY: docker-build
docker-build: need-docker  ## build the image mrp, which runs the four nodes anywhere
	$(IMAGE_OF) --target runtime --tag $(IMAGE) -

.PHONY: docker-build-ssh
docker-build-ssh: docker-build  ## build the image for docker/several_hosts/remote.yaml
	$(IMAGE_OF) --target ssh --tag mrp-ssh:$(DEBIAN) -

.PHONY: docker-build-view
docker-build-view: docker-build
	$(IMAGE_OF) --target view --tag mrp-view:$(DEBIAN) -

.PHONY: docker-build-check
docker-build-check: need-docker  ## build the image that checks any package: docker run --rm -v $PWD:/pkg mrp-check:trixie /pkg
	$(CHECK_IMAGE)

.PHONY: docker-build-class
docker-build-class: need-docker  ## build the image for docker/class.yaml, which checks a class
	$(IMAGE_OF) --target class --tag mrp-class:$(DEBIAN) -

# For the workflow: an image of a stage, with a list of what is in it and of how it was made, to a registry.
PUSH := docker buildx build --push --sbom=true --provenance=mode=max
NAME_runtime := mrp
NAME_view := mrp-view
NAME_check := mrp-check
docker-push-%:
	$(subst docker build,$(PUSH),$(IMAGE_OF)) --target $* \
	  --tag $(REGISTRY)/$(NAME_$*):$(TAG) -

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
docker-down: need-docker  ## remove what docker-up or docker-view leaves
	@$(COMPOSE_MRP) --profile view down

.PHONY: docker-test
docker-test: docker-suite docker-harm docker-containers  ## run every test in a container, and test the containers

# `make test-all`, in a container without a network. Its name is one that it can resolve,
# which roswtf asks for. Some tests make processes without end: the engine, too, sees to it that they
# stay few.
.PHONY: docker-suite
docker-suite: need-docker
	$(TEST_IMAGE)
	@rm -rf $(DOCKER_RESULTS)/suite; mkdir -p $(DOCKER_RESULTS)/suite
	docker run --rm --init --network none --hostname localhost --pids-limit 4000 \
	  --user "$$(id -u):$$(id -g)" --volume $(DOCKER_RESULTS)/suite:/results mrp-test:$(DEBIAN)

# The checker's tests with what means harm, where `make docker-check` checks a package: as root, and as
# another user.
.PHONY: docker-harm
docker-harm: need-docker
	$(TEST_IMAGE)
	@for user in 0:0 65534:65534; do \
	  $(IN_BOUNDS) --user $$user mrp-test:$(DEBIAN) env -C catkin_ws /usr/bin/python3 -m pytest \
	    -p no:cacheprovider src/mrp_check/test/test_check_{confine,reach,harm}.py; done

# The package is read alone, and nothing that it does reaches this machine.
.PHONY: docker-check
docker-check: need-docker  ## check the package at PKG in a container without a network
	@test -e "$(PKG)/package.xml" || { \
	  echo "error: expected PKG=PATH, the folder of a package; '$(PKG)' has no package.xml" >&2; exit 2; }
	$(CHECK_IMAGE)
	@$(IN_BOUNDS) --volume "$(abspath $(PKG)):/package:ro" mrp-check:$(DEBIAN) --spec pub_sub /package

.PHONY: need-pytest
need-pytest: need-docker
	@/usr/bin/python3 -c 'import pytest, xdist' 2> /dev/null || \
	  catkin_ws/tools/install_packages.sh <(printf '%s\n' '# to test the containers' python3-pytest-xdist)

TEST_CONTAINERS = MRP_TEST_ENGINE=yes /usr/bin/python3 -m pytest -n 4 --dist loadgroup -m 'not dev' \
  --junit-xml=$(DOCKER_RESULTS)/containers.xml

.PHONY: docker-containers
docker-containers: docker-build-ssh docker-build-check docker-build-class need-pytest
	@$(TEST_CONTAINERS) docker/test

.PHONY: docker-image
docker-image: docker-build need-pytest
	@$(TEST_CONTAINERS) docker/test/test_image.py docker/test/test_run.py

# A node is built there, before it can run.
.PHONY: docker-dev
docker-dev: need-pytest
	@catkin_ws/tools/install_others.sh
	@MRP_TEST_ENGINE=yes MRP_TEST_DEADLINE=600 /usr/bin/python3 -m pytest -m dev docker/test
