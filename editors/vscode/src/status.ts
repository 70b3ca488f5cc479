/** The words of the status bar. */

import type { Preview, RunStatus } from "./preview/protocol";

export type ServerState = "starting" | "running" | "stopped";

export interface Words {
  text: string;
  tooltip: string;
  severity: "none" | "warning" | "error";
}

const counted = (count: number, one: string, many = one + "s"): string => `${count} ${count === 1 ? one : many}`;

/** What a picture tells of its run. */
export function runOf({ uri, version, status, degrees, seconds, problems }: Preview): RunStatus {
  const count = (severity: string): number => problems.filter((problem) => problem.severity === severity).length;
  return {
    uri,
    version,
    status,
    degrees,
    seconds,
    problems: { errors: count("error"), warnings: count("warning") },
  };
}

/** `run` is null as long as the program has not been run. */
export function wordsFor(server: ServerState, run: RunStatus | null): Words {
  if (server === "starting")
    return { text: "$(sync~spin) AIDL", tooltip: "The language server starts.", severity: "none" };
  if (server === "stopped")
    return {
      text: "$(debug-disconnect) AIDL",
      tooltip: "The language server does not run. Click to start it again.",
      severity: "warning",
    };
  if (run === null) return { text: "AIDL", tooltip: "This program has not been solved yet.", severity: "none" };
  const { errors, warnings } = run.problems;
  const facts = [
    SENTENCES[run.status],
    run.degrees === null ? "" : `${counted(run.degrees, "degree", "degrees")} of freedom.`,
    errors + warnings === 0 ? "" : `${counted(errors, "error")}, ${counted(warnings, "warning")}.`,
    `The last run took ${run.seconds < 1 ? `${Math.round(run.seconds * 1000)} ms` : `${run.seconds.toFixed(1)} s`}.`,
    "Click to open the preview.",
  ];
  const short = run.degrees === null || run.degrees === 0 ? "" : ` · ${run.degrees} free`;
  return {
    text: `${ICONS[run.status]} ${LABELS[run.status]}${run.status === "wrong" ? "" : short}`,
    tooltip: facts.filter((fact) => fact !== "").join(" "),
    severity: run.status === "solved" ? "none" : run.status === "partial" ? "warning" : "error",
  };
}

const ICONS = { solved: "$(check)", partial: "$(warning)", failed: "$(error)", wrong: "$(error)" };
const LABELS = { solved: "Solved", partial: "Partly solved", failed: "Not solved", wrong: "Not drawn" };
const SENTENCES = {
  solved: "All constraints hold.",
  partial: "Some constraints do not hold.",
  failed: "The constraints could not be solved.",
  wrong: "The program has mistakes and was not solved.",
};
