// SPDX-License-Identifier: BSD-3-Clause
// The WebSocket: requests with their answers, and opening it again with growing pauses when it closes.
import { type Asks, type ServerBinary, type ServerText, SUBPROTOCOL, decodeBinary } from "../protocol";

const FIRST_PAUSE_MS = 500;
const LONGEST_PAUSE_MS = 10_000;
const ANSWER_WITHIN_MS = 20_000;

/** Pause before attempt 1, 2, ... to open the socket again. */
export function pauseBefore(attempt: number): number {
  return Math.min(LONGEST_PAUSE_MS, FIRST_PAUSE_MS * 2 ** (attempt - 1));
}

export interface Handlers {
  text(message: ServerText): void;
  binary(message: ServerBinary): void;
  opened(): void;
  /** The socket is closed; the next attempt is in pause_ms. */
  closed(pause_ms: number): void;
}

interface Waiting {
  resolve(value: never): void;
  reject(error: Error): void;
  timer: ReturnType<typeof setTimeout>;
}

export class Connection {
  private socket: WebSocket | null = null;
  private attempt = 0;
  private lastId = 0;
  private waiting = new Map<number, Waiting>();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private ended = false;

  constructor(
    private url: string,
    private handlers: Handlers,
  ) {
    this.open();
  }

  /** Ends for good, for instance when the versions differ. */
  end() {
    this.ended = true;
    clearTimeout(this.timer);
    this.socket?.close();
  }

  retryNow() {
    if (this.socket || this.ended) return;
    clearTimeout(this.timer);
    this.open();
  }

  ask<Name extends keyof Asks>(ask: Name, more: Asks[Name][0]): Promise<Asks[Name][1]> {
    const socket = this.socket;
    if (!socket || socket.readyState !== WebSocket.OPEN) return Promise.reject(new Error("The monitor is not connected."));
    const id = ++this.lastId;
    socket.send(JSON.stringify({ ask, id, ...more }));
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this.waiting.delete(id);
        reject(new Error("The monitor did not answer in time."));
      }, ANSWER_WITHIN_MS);
      this.waiting.set(id, { resolve: resolve as (value: never) => void, reject, timer });
    });
  }

  private open() {
    const socket = new WebSocket(this.url, SUBPROTOCOL);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.attempt = 0;
      this.handlers.opened();
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      if (typeof event.data === "string") this.receiveText(event.data);
      else {
        const message = decodeBinary(event.data);
        if (message) this.handlers.binary(message);
      }
    };
    socket.onclose = () => {
      this.socket = null;
      for (const { reject, timer } of this.waiting.values()) {
        clearTimeout(timer);
        reject(new Error("The connection to the monitor closed."));
      }
      this.waiting.clear();
      if (this.ended) return;
      const pause = pauseBefore(++this.attempt);
      this.handlers.closed(pause);
      this.timer = setTimeout(() => this.open(), pause);
    };
  }

  private receiveText(text: string) {
    const message = JSON.parse(text) as ServerText;
    if (message.type !== "reply") {
      this.handlers.text(message);
      return;
    }
    const waiting = this.waiting.get(message.id);
    if (!waiting) return;
    this.waiting.delete(message.id);
    clearTimeout(waiting.timer);
    if (message.ok) waiting.resolve(message as never);
    else waiting.reject(new Error(message.error ?? "The monitor refused."));
  }
}
