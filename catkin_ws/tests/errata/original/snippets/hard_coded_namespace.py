# SPDX-License-Identifier: CC-BY-4.0
# By Paul N. Beuchat, 2023: see ../README.md. Printed here with its mistakes.

# Put the hard-coded namespace string into a global variable for this script
global my_global_namespace = "/my_global_namespace"
