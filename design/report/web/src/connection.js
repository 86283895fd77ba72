// SPDX-License-Identifier: MIT
// The program behind a page of the studio: what it tells, as server-sent events, and what it is asked, as calls.
import { byId } from "./dom.js";

const names = ["opened", "fault", "asked", "progress", "refused", "motion", "numbers", "gradient", "pairs", "settled", "tune", "writer"];
const patience = 2500, again = 2000;  // ms: until silence counts as an end; between attempts that the browser does not make by itself

const randomName = () => crypto.randomUUID?.() ?? Array.from(crypto.getRandomValues(new Uint8Array(16)), (x) => x.toString(16).padStart(2, "0")).join("");

export class Connection {
  // hear(name, what) for each event, onLink("connected" | "waiting" | "ended") as the connection comes and goes.
  constructor(hear, onLink) {
    this.hear = hear;
    this.onLink = onLink;
    this.query = new URLSearchParams({ token: new URLSearchParams(location.search).get("token") ?? "", client: randomName() });
    this.open();
  }

  open() {
    const source = new EventSource(`events?${this.query}`);
    source.onopen = () => {
      clearTimeout(this.silence);
      this.silence = 0;
      this.onLink("connected");
    };
    source.onerror = () => {
      if (!this.silence) {
        this.onLink("waiting");
        this.silence = setTimeout(() => this.onLink("ended"), patience);
      }
      if (source.readyState === EventSource.CLOSED) setTimeout(() => this.open(), again);
    };
    for (const name of names) source.addEventListener(name, (event) => this.hear(name, JSON.parse(event.data)));
  }

  // The answer to {do: ..., ...}. Throws an error with a sentence, and with what else the program says (`told`).
  async call(body) {
    let answer;
    try {
      answer = await fetch(`call?${this.query}`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
    } catch {
      throw new Error("The program does not answer.");
    }
    const told = await answer.json().catch(() => ({}));
    if (!answer.ok || told.error) throw Object.assign(new Error(told.error ?? `The program answers with status ${answer.status}.`), { told });
    return told;
  }
}

// What the page was made of, as an event would tell it.
export const firstOpened = () => JSON.parse(byId("fettle-report").textContent);
