import { unpack } from "./packed.js";

/** How long to wait before the server is looked for again, at first and at most [ms]. */
const AGAIN = [1000, 15000];

/** The line to the program: questions with answers, and news that come by themselves. */
export class Connection {
  /**
   * @param {{tell: (words: any) => void, show: (packed: import("./packed.js").Packed) => void,
   *   lost: () => void, found: () => void}} heard
   */
  constructor(heard) {
    this.heard = heard;
    this.number = 0;
    this.pause = AGAIN[0];
    /** @type {Map<number, {done: (reply: any) => void, failed: (error: Error) => void}>} */
    this.waiting = new Map();
    this.open();
  }

  open() {
    const address = new URL("socket", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.pause = AGAIN[0];
      this.heard.found();
    };
    this.socket.onmessage = (event) => this.hear(event.data);
    this.socket.onclose = () => {
      for (const { failed } of this.waiting.values()) failed(new Error("the connection is lost"));
      this.waiting.clear();
      this.heard.lost();
      setTimeout(() => this.open(), this.pause);
      this.pause = Math.min(AGAIN[1], 1.5 * this.pause); // each time is a line in the program's log
    };
  }

  get isOpen() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /**
   * Ask for something.
   * @param {string} what
   * @param {object} values
   * @returns {Promise<any>} The answer; rejected with the one line that says why not.
   */
  ask(what, values = {}) {
    if (!this.isOpen) return Promise.reject(new Error("the connection is lost; nothing was changed"));
    const number = ++this.number;
    this.socket?.send(JSON.stringify({ number, ask: what, ...values }));
    return new Promise((done, failed) => this.waiting.set(number, { done, failed }));
  }

  /** @param {string | ArrayBuffer} data */
  hear(data) {
    if (data instanceof ArrayBuffer) {
      this.heard.show(unpack(data));
      return;
    }
    const words = JSON.parse(data);
    if (!("re" in words)) {
      this.heard.tell(words);
      return;
    }
    const waiting = this.waiting.get(words.re);
    this.waiting.delete(words.re);
    if (words.error) waiting?.failed(new Error(words.error));
    else waiting?.done(words);
  }
}
