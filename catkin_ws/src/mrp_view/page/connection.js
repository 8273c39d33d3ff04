// SPDX-License-Identifier: BSD-3-Clause
// The WebSocket to the viewer: opened again whenever it is lost.

const FIRST_WAIT = 500; // milliseconds
const LONGEST_WAIT = 5000;
const SILENCE = 10000; // after which a connection is taken for lost: the viewer speaks ten times a second

export class Connection {
  // onMessage(message), onState("live" or "lost"); options() returns what the viewer is told first.
  constructor(onMessage, onState, options) {
    this.onMessage = onMessage;
    this.onState = onState;
    this.options = options;
    this.wait = FIRST_WAIT;
    this.paused = false;
    this.open();
    setInterval(() => this.check(), 1000);
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/socket`);
    this.socket = socket;
    this.heard = performance.now();
    socket.onopen = () => {
      this.wait = FIRST_WAIT;
      this.tell();
      this.onState("live");
    };
    socket.onmessage = (event) => {
      this.heard = performance.now();
      this.onMessage(JSON.parse(event.data));
    };
    socket.onclose = () => {
      if (this.socket !== socket || this.paused) return;
      this.onState("lost");
      setTimeout(() => {
        if (this.socket === socket && !this.paused) this.open();
      }, this.wait);
      this.wait = Math.min(this.wait * 2, LONGEST_WAIT);
    };
  }

  check() {
    const silent = performance.now() - this.heard > SILENCE;
    if (this.socket.readyState === WebSocket.OPEN && silent) this.socket.close();
  }

  tell() {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    this.socket.send(JSON.stringify(this.options()));
  }

  // While it is paused, there is no connection.
  pause(paused) {
    this.paused = paused;
    if (paused) this.socket.close();
    else this.open();
  }
}
