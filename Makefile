# The front door: `make` alone prints what there is.

SHELL := /bin/bash
.SHELLFLAGS := -e -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory

# A pyenv or conda python first on PATH breaks catkin and every Python node.
USER_PATH := $(PATH)
export PATH := /usr/bin:/bin:/usr/sbin:/sbin:$(PATH)

# Another workspace, sourced in the user's shell, is none of this one's business.
unexport CMAKE_PREFIX_PATH ROS_PACKAGE_PATH PYTHONPATH

# ROS 1 has no authentication: unless the user says otherwise, listen on this machine only.
ifeq ($(ROS_IP)$(ROS_HOSTNAME),)
export ROS_HOSTNAME := localhost
endif

# Debian's ROS needs no set-up; ROS Noetic proper has a file to source.
NOETIC := $(wildcard /opt/ros/noetic/setup.bash)
SOURCE_ROS := $(if $(NOETIC),source $(NOETIC);)
SOURCE_WORKSPACE := source devel/setup.bash;

IN_WORKSPACE := cd catkin_ws;
CATKIN_MAKE := catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=RelWithDebInfo
INSTALL := catkin_ws/tools/install_packages.sh
PACKAGES := $(addprefix catkin_ws/apt/,build.txt runtime.txt tools.txt test.txt)
BUILT := catkin_ws/devel/.built
RESULTS := $(CURDIR)/catkin_ws/build/test_results

.PHONY: help
help:  ## print the targets
	@sed -n 's/^\([a-z-]*\):.*##/\1/p' $(MAKEFILE_LIST) | \
	  while read -r target text; do printf '  make %-8s %s\n' "$$target" "$$text"; done

.PHONY: deps
deps:  ## install the Debian packages that building, running and testing need
	@$(INSTALL) $(PACKAGES)

.PHONY: build
build: deps $(BUILT)  ## build the workspace with catkin_make

$(BUILT): $(shell find catkin_ws/src -type f -not -name '*.pyc' -not -path catkin_ws/src/CMakeLists.txt) | deps
	$(IN_WORKSPACE) $(SOURCE_ROS) $(CATKIN_MAKE)
	@touch $@

.PHONY: run
run: build  ## run the four nodes; end them with Ctrl-C
	@$(IN_WORKSPACE) $(SOURCE_WORKSPACE) exec roslaunch mrp pub_sub.launch

# The tests bring their own master and talk to this machine alone, whatever the user's shell says.
ALONE := unset ROS_IP ROS_NAMESPACE ROS_MASTER_URI;

.PHONY: test
test: export ROS_HOSTNAME := localhost
test: export ROS_LOG_DIR := $(CURDIR)/catkin_ws/build/test_logs
test: build  ## build, run every test, and print one summary
	@rm -rf $(RESULTS)
	$(IN_WORKSPACE) $(SOURCE_ROS) $(ALONE) $(CATKIN_MAKE) run_tests -j1
	@$(IN_WORKSPACE) $(SOURCE_WORKSPACE) $(ALONE) status=0; \
	/usr/bin/python3 -m pytest -n 3 --junit-xml=$(RESULTS)/workspace.xml tests || status=1; \
	catkin_test_results $(RESULTS) > /dev/null || status=1; \
	tools/test_summary.py $(RESULTS) || status=1; \
	exit $$status

.PHONY: lint
lint:  ## check the style of all sources
	@$(INSTALL) $(PACKAGES) catkin_ws/apt/lint.txt
	@catkin_ws/tools/lint.sh

.PHONY: doctor
doctor:  ## find what keeps the tutorial from running on this machine
	@test -x /usr/bin/python3 || { echo "[FAIL] expected /usr/bin/python3; there is none"; \
	  echo "       mend: make deps"; exit 1; }
	@PATH="$(USER_PATH)" /usr/bin/python3 catkin_ws/tools/doctor.py

.PHONY: clean
clean:  ## delete all that was built
	rm -rf catkin_ws/build catkin_ws/devel catkin_ws/install
	rm -f catkin_ws/src/CMakeLists.txt catkin_ws/.catkin_workspace
