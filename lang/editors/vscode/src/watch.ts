// One run of `luxel watch --preview`: what it tells, and how it ends. Knows nothing of the editor.

import { spawn, type ChildProcess } from "node:child_process";
import { existsSync, watch, type FSWatcher } from "node:fs";
import { basename, dirname, join } from "node:path";
import { createInterface } from "node:readline";

/** What a watch tells of itself. */
export interface Listener {
  /** The page that shows the picture as it grows. */
  address(url: string): void;
  /** A picture is there: at once one of the first sample, then the finished one. */
  picture(png: string): void;
  /** A mistake of the scene, or what the program says of itself; empty when a picture is finished. */
  message(text: string): void;
  /** It has ended: by itself with an exit code, or because it could not be started. */
  ended(how: number | Error | null): void;
}

/** How long a watch has to end by itself, in milliseconds. */
const PATIENCE = 3000;

/** Where and how a watch is to run. */
export interface Start {
  /** The program `luxel`. */
  program: string;
  /** The scene. */
  scene: string;
  /** Where the pictures go. */
  folder: string;
  /** What opens a line in the editor. */
  editor: string;
  /** What else the program is given. */
  more: readonly string[];
}

/** A running watch. */
export class Watch {
  private readonly child: ChildProcess;
  private files: FSWatcher | undefined;
  private isOver = false;

  constructor(start: Start, private readonly listener: Listener) {
    const output = join(start.folder, basename(start.scene, ".scene"));
    const given = ["watch", start.scene, "--preview", "--no-open", "--json", "--editor", start.editor, "-o", output];
    // A scene writes its assets' names from its own folder.
    this.child = spawn(start.program, [...given, ...start.more], {
      cwd: dirname(start.scene),
      stdio: ["ignore", "pipe", "pipe"],
    });
    this.child.on("error", (error) => this.end(error));
    this.child.on("close", (code) => this.end(code));
    this.lines(this.child.stdout, (line) => this.summary(line));
    this.lines(this.child.stderr, (line) => this.remark(line));
    this.look(start.folder, `${output}.png`);
  }

  /** Ends the watch as Ctrl-C does, or after a while in any case. */
  stop(): void {
    if (this.isOver) return;
    this.child.kill("SIGINT");
    const patience = setTimeout(() => this.child.kill("SIGKILL"), PATIENCE);
    patience.unref();
    this.child.once("close", () => clearTimeout(patience));
  }

  /** Of the first sample no line is printed: the picture appears. */
  private look(folder: string, png: string): void {
    const fails = (error: unknown) => this.listener.message(`the first picture cannot be waited for: ${String(error)}`);
    try {
      this.files = watch(folder, (_, name) => {
        if (name === basename(png) && existsSync(png)) this.listener.picture(png);
      });
      this.files.on("error", fails);
    } catch (error) {
      fails(error);
    }
  }

  private lines(stream: NodeJS.ReadableStream | null, take: (line: string) => void): void {
    if (stream) createInterface({ input: stream }).on("line", take);
  }

  private summary(line: string): void {
    const told = object(line);
    if (typeof told?.png !== "string") return;
    this.listener.picture(told.png);
    this.listener.message("");
  }

  private remark(line: string): void {
    const address = /^preview: (http:\/\/\S+)$/.exec(line)?.[1];
    if (address !== undefined) return this.listener.address(address);
    const told = object(line);
    if (told === undefined) return this.listener.message(line);
    if (told.severity === "error" && typeof told.message === "string") {
      // What has no place is of a scene all the same; what is of none has no file either.
      const parts = [told.file, told.line, told.column].filter((part) => part !== null && part !== undefined);
      this.listener.message(parts.length > 0 ? `${parts.join(":")}: ${told.message}` : told.message);
    }
  }

  private end(how: number | Error | null): void {
    if (this.isOver) return;
    this.isOver = true;
    this.files?.close();
    this.listener.ended(how);
  }
}

/** A line of JSON that holds an object. */
function object(line: string): Record<string, unknown> | undefined {
  try {
    const value: unknown = JSON.parse(line);
    return typeof value === "object" && value !== null ? (value as Record<string, unknown>) : undefined;
  } catch {
    return undefined;
  }
}
