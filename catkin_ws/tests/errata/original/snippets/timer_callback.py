# SPDX-License-Identifier: CC-BY-4.0
# By Paul N. Beuchat, 2023: see ../README.md. Printed here with its mistakes.

# Implement the timer callback
def timerCallback(self, event):
    self.counter += 2
    // Publish a message
    self.m_publisher.publish(self.counter)
