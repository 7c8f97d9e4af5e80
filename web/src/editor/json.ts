// Where a text stops being JSON, or has a key twice, and why. Browsers say it in words of their own, in English, and not all of them say where.

import { t } from "../core/texts";

export interface Fault {
  /** Offset of what does not fit. */
  at: number;
  why: string;
  /** A key that is written twice: to JSON it is none, but the engine reads no such scene. */
  twice?: true;
}

const NUMBER = /-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?/y;
const WORD = /[+\-.\w]+/y;
const SPACE = /[ \t\r\n]*/y;

/** The first place that is not JSON, or has a key again; nothing where the text has no such place. */
export function firstFault(text: string): Fault | undefined {
  const fault = new Reader(text).read();
  if (fault) return fault;
  try {
    JSON.parse(text);
    return undefined;
  } catch (error) {
    // What the reader does not see, the browser has seen.
    return { at: text.length, why: error instanceof Error ? error.message : String(error) };
  }
}

/** Reads a text to the first fault. */
class Reader {
  private at = 0;

  constructor(private readonly text: string) {}

  read(): Fault | undefined {
    const fault = this.value();
    if (fault) return fault;
    this.space();
    return this.at < this.text.length ? this.fault(t("The scene ended before this.")) : undefined;
  }

  private fault(why: string, at = this.at): Fault {
    return { at, why };
  }

  private match(pattern: RegExp): string {
    pattern.lastIndex = this.at;
    return pattern.exec(this.text)?.[0] ?? "";
  }

  private space(): void {
    this.at += this.match(SPACE).length;
  }

  private sign(): string {
    return this.text[this.at] ?? "";
  }

  private value(): Fault | undefined {
    this.space();
    const sign = this.sign();
    if (sign === "{") {
      const keys = new Set<string>();
      return this.list("}", () => this.member(keys));
    }
    if (sign === "[") return this.list("]", () => this.value());
    if (sign === '"') return this.string();
    return this.plain(sign);
  }

  /** A number, true, false or null; else what somebody may have meant. */
  private plain(sign: string): Fault | undefined {
    const word = this.match(WORD);
    if (/^(?:true|false|null)$/.test(word) || (word !== "" && this.match(NUMBER) === word)) {
      this.at += word.length;
      return undefined;
    }
    if (word !== "") {
      return this.fault(
        /^[+\-.\d]/.test(word)
          ? t("{word} is not a number: write one like -0.5, 12 or 1e-3.", { word })
          : t("{word} is neither a number nor a text: a text stands between double quotes.", { word }),
      );
    }
    return this.stray(sign);
  }

  private stray(sign: string): Fault {
    if (sign === "") return this.fault(t("The text ends here, and something is still open."));
    if (sign === "/") return this.fault(t("A comment: JSON has none."));
    if (sign === "'" || sign === "“" || sign === "„")
      return this.fault(t('A text stands between straight double quotes: "like this".'));
    return this.fault(t("A value is missing before {sign}", { sign }));
  }

  private string(): Fault | undefined {
    const start = this.at;
    for (this.at += 1; this.at < this.text.length && this.sign() !== "\n"; this.at += 1) {
      if (this.sign() === '"') {
        this.at += 1;
        return this.badEscape(start);
      }
      if (this.sign() === "\\") this.at += 1;
    }
    return this.fault(t("This text has no quote at its end."), start);
  }

  private badEscape(start: number): Fault | undefined {
    try {
      JSON.parse(this.text.slice(start, this.at));
      return undefined;
    } catch {
      return this.fault(
        t("In this text stands a sign that JSON writes otherwise: a backslash as \\\\."),
        start,
      );
    }
  }

  /** A key and its value; `keys` are those before it. */
  private member(keys: Set<string>): Fault | undefined {
    if (this.sign() !== '"') {
      const word = this.match(WORD);
      return word === ""
        ? this.stray(this.sign())
        : this.fault(t("The key {word} stands between double quotes.", { word }));
    }
    const start = this.at;
    const fault = this.string();
    if (fault) return fault;
    const key = JSON.parse(this.text.slice(start, this.at)) as string;
    if (keys.has(key))
      return {
        ...this.fault(t("The key {key} is written twice: it stands above already.", { key }), start),
        twice: true,
      };
    keys.add(key);
    this.space();
    if (this.sign() !== ":") return this.fault(t("A colon is missing between the key and its value."));
    this.at += 1;
    return this.value();
  }

  /** What stands between braces or brackets, parted by commas. */
  private list(close: string, element: () => Fault | undefined): Fault | undefined {
    this.at += 1;
    this.space();
    if (this.sign() === close) {
      this.at += 1;
      return undefined;
    }
    for (;;) {
      this.space();
      const fault = element();
      if (fault) return fault;
      this.space();
      const { at } = this;
      const sign = this.sign();
      this.at += 1;
      if (sign === close) return undefined;
      if (sign !== ",") return this.unparted(sign, close, at);
      this.space();
      if (this.sign() === close) return this.fault(t("The comma before {close} is too many.", { close }), at);
    }
  }

  private unparted(sign: string, close: string, at: number): Fault {
    if (sign === "") return this.fault(t("The text ends here, and {close} is missing.", { close }), at);
    if (sign === "}" || sign === "]")
      return this.fault(t("{sign} stands here, where {close} is missing.", { sign, close }), at);
    if (sign === "/") return this.fault(t("A comment: JSON has none."), at);
    return this.fault(t("A comma is missing before this."), at);
  }
}
