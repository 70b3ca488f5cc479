"""What is reported on a folder of records: tables for readers and programs, and the gallery, all runs on one
page: pictures, programs, losses, requirements. It needs only the pictures beside it.

Programs and replies are strangers' text: everything is escaped, and the page allows no script but its own.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

from aidl_eval import recordings, table
from aidl_eval.clip import MODEL, Scores, score_all
from aidl_eval.plan import key_of
from aidl_eval.preference import study_of
from aidl_eval.requirements import Status
from aidl_eval.store import Store, picture_path
from aidl_eval.summary import MEANINGS, WITHIN, Row, names, pairs, rows
from aidl_eval.table import shown
from aidl_lang.common.prose import counted

Record = Mapping[str, Any]

_MARKS = {Status.MET: "✓", Status.FAILED: "✗", Status.UNMEASURABLE: "?"}
_NAMES = {"degrees": "degrees of freedom", "detached": "detached pieces"}
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_LONGEST = 20_000
"""Most characters of a program or a reply that are shown."""


def report(store: Store, weights: str | None = None, model: str = MODEL) -> str:
    """Writes `evaluation.md`, `.csv`, `.json`, `index.html` and `recording.jsonl`, and returns the Markdown.
    Raises StoreError.
    """
    records = store.records()
    scores = score_all(store, records, weights, model)
    settings = store.settings()
    attempts = settings.get("attempts")
    limit = attempts if isinstance(attempts, int) else WITHIN[-1]
    study = study_of(store, records)
    variants, prompts = (rows(records, scores, each, limit, study) for each in (False, True))
    differences = pairs(variants, study=study)
    text = table.markdown(variants, prompts, differences, recordings.notes(records, settings), study)
    outputs = {
        "recording.jsonl": recordings.written(records, settings),
        "evaluation.md": text,
        "evaluation.csv": table.to_csv([*variants, *prompts], differences, study),
        "evaluation.json": table.to_json(variants, prompts, differences, study),
        "index.html": page(store.folder, records, variants, scores),
    }
    for name, content in outputs.items():
        encoding = "utf-8-sig" if name.endswith(".csv") else "utf-8"
        store.write(name, content.encode(encoding, "backslashreplace"))
    return text


def page(folder: Path, records: Sequence[Record], rows: Sequence[Row], scores: Scores) -> str:
    """Returns the page to be written to `folder`, beside the pictures."""
    prompts = dict.fromkeys(r["prompt"] for r in records)
    variants = dict.fromkeys(row.variant for row in rows)
    return "\n".join(
        [
            "<!doctype html>",
            '<html lang="en"><head><meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{_policy()}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>AIDL evaluation</title><style>{_STYLE}</style></head><body>",
            "<header><h1>AIDL evaluation</h1>",
            _figures(rows),
            "<form>",
            _choice("prompt", prompts),
            _choice("variant", variants),
            _choice("validity", ("valid", "not valid", "requirement failed", "something lost")),
            '<span id="count"></span></form></header>',
            "<main>",
            *(
                _prompt(prompt, [r for r in records if r["prompt"] == prompt], folder, scores)
                for prompt in prompts
            ),
            f"</main><script>{_SCRIPT}</script></body></html>\n",
        ]
    )


def _policy() -> str:
    allowed = base64.b64encode(hashlib.sha256(_SCRIPT.encode()).digest()).decode()
    return (
        f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{allowed}'; "
        "img-src 'self' file:; form-action 'none'; base-uri 'none'"
    )


def _text(value: object) -> str:
    """Returns text to show: escaped, of limited length, without characters that steer the reader's screen."""
    text = str(value)
    cut = f"{text[:_LONGEST]}\n… {len(text) - _LONGEST} more characters" if len(text) > _LONGEST else text
    return escape(_CONTROL.sub("\ufffd", cut))


def _figures(rows: Sequence[Row]) -> str:
    head = "".join(f"<th>{_text(row.variant)}</th>" for row in rows)
    lines = "".join(
        f'<tr><th title="{_text(MEANINGS[name])}">{_text(name)}</th>'
        + "".join(f"<td>{_text(shown(row.figures[name]))}</td>" for row in rows)
        + "</tr>"
        for name in names(rows)
    )
    return f"<details><summary>Figures</summary><table><tr><th></th>{head}</tr>{lines}</table></details>"


def _choice(name: str, values: Iterable[str]) -> str:
    options = "".join(f"<option>{_text(value)}</option>" for value in values)
    return f'<label>{name} <select name="{name}"><option value="">all</option>{options}</select></label>'


def _prompt(name: str, records: Sequence[Record], folder: Path, scores: Scores) -> str:
    asked = next((r["text"] for r in records if "text" in r), "")
    cells = "\n".join(_cell(record, folder, scores) for record in records)
    head = f'<h2>{_text(name)}</h2><p class="asked">{_text(asked)}</p>'
    return f'<section>{head}<div class="cells">{cells}</div></section>'


def _cell(record: Record, folder: Path, scores: Scores) -> str:
    key = key_of(record)
    tags = " ".join(_tags(record))
    head = f"<h3>{_text(record['variant'])} <small>run {_text(record['run'])}</small></h3>"
    if "failure" in record:
        body = f'<p class="none">broke off</p><p>{_text(record["failure"]["message"])}</p>'
    else:
        body = (
            f"{_picture(record, key, folder)}{_facts(record, scores.of.get(key))}{''.join(_folded(record))}"
        )
    return (
        f'<article data-prompt="{_text(record["prompt"])}" data-variant="{_text(record["variant"])}" '
        f'data-validity="{tags}">{head}{body}</article>'
    )


def _tags(record: Record) -> Iterator[str]:
    """Yields the words, without blanks, by which a record can be selected."""
    yield "valid" if record.get("ok") else "not-valid"
    if any(result["status"] != Status.MET for result in record.get("requirements", ())):
        yield "requirement-failed"
    if record.get("missing"):
        yield "something-lost"


def _picture(record: Record, key: str, folder: Path) -> str:
    path = picture_path(key)
    if record["ok"] and (folder / path).is_file():
        about = f"{record['prompt']}, {record['variant']}, run {record['run']}"
        return f'<img loading="lazy" src="{quote(path)}" alt="{_text(about)}">'
    return f'<p class="none">{"no picture" if record["ok"] else "not valid"}</p>'


def _facts(record: Record, score: float | None) -> str:
    count = len(record["attempts"])
    facts = [counted(count, "attempt")]
    facts += [f"{value:g} {_NAMES.get(name, name)}" for name, value in record.get("numbers", {}).items()]
    if edits := record.get("edits", {}).get("edits"):
        facts.append(f"{sum(e['outcome'] == 'kept' for e in edits)}/{len(edits)} edits kept")
    if score is not None:
        facts.append(f"CLIP {score:.1f}")
    facts += [f"{what} not measured: {why}" for what, why in record.get("unmeasured", {}).items()]
    return f'<p class="facts">{_text(" · ".join(facts))}</p>'


def _folded(record: Record) -> Iterator[str]:
    """Yields the unfolding parts: requirements, losses, the program, and the attempts."""
    results = record.get("requirements", ())
    if results:
        met = sum(result["status"] == Status.MET for result in results)
        items = "".join(
            f'<li class="{_text(r["status"])}"><b>{_MARKS[Status(r["status"])]}</b> {_text(r["text"])}'
            + (f"<br><small>{_text(r['detail'])}</small>" if r["detail"] else "")
            + "</li>"
            for r in results
        )
        yield _details(f"{met}/{len(results)} requirements", f"<ul>{items}</ul>")
    if record["missing"]:
        items = "".join(f"<li>{_text(phrase)}</li>" for phrase in record["missing"])
        yield _details(f"{len(record['missing'])} lost", f"<ul>{items}</ul>", "lost")
    if record["program"] is not None:
        yield _details("program", f"<pre>{_text(record['program'])}</pre>")
    yield _details("attempts", "".join(_attempt(n, a) for n, a in enumerate(record["attempts"], 1)))


def _attempt(number: int, attempt: Record) -> str:
    verdict = attempt["verdict"]
    codes = ", ".join(dict.fromkeys(verdict["codes"])) if verdict else ""
    came = "no program" if verdict is None else "valid" if verdict["ok"] else f"{verdict['stage']}: {codes}"
    answer = f"<h4>told</h4><pre>{_text(attempt['answer'])}</pre>" if attempt["answer"] else ""
    return _details(f"{number}: {came}", f"<pre>{_text(attempt['reply'])}</pre>{answer}")


def _details(summary: str, body: str, kind: str = "") -> str:
    return f'<details class="{kind}"><summary>{_text(summary)}</summary>{body}</details>'


_STYLE = """
:root { color-scheme: light dark; --back: #f6f7f9; --card: #fff; --ink: #1e293b; --faint: #5b6675;
  --line: #d5dbe3; --good: #15803d; --bad: #b91c1c; }
@media (prefers-color-scheme: dark) { :root { --back: #12161c; --card: #1b212a; --ink: #e2e8f0;
  --faint: #9aa6b6; --line: #333d4a; --good: #4ade80; --bad: #f87171; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--ink); font: 15px/1.45 system-ui, sans-serif; }
header, main { max-width: 1500px; margin: 0 auto; padding: 0 20px; }
h1 { font-size: 22px; margin: 20px 0 8px; } h2 { font-size: 18px; margin: 28px 0 0; }
h3 { font-size: 14px; margin: 0 0 8px; }
h3 small, .asked, .facts { color: var(--faint); font-weight: normal; }
h4 { font-size: 12px; margin: 6px 0 2px; color: var(--faint); }
.asked { margin: 0 0 8px; } .facts { font-size: 12px; margin: 8px 0; }
form { position: sticky; top: 0; display: flex; flex-wrap: wrap; gap: 8px 16px; padding: 10px 0; }
select { font: inherit; max-width: 16em; }
.cells { display: grid; align-items: start; gap: 14px;
  grid-template-columns: repeat(auto-fill, minmax(260px, 1fr)); }
article { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 12px;
  min-width: 0; }
article[hidden], section[hidden] { display: none; }
img { display: block; width: 100%; aspect-ratio: 1; object-fit: contain; background: #fff;
  border-radius: 4px; }
.none { display: grid; place-items: center; aspect-ratio: 1; margin: 0; color: var(--faint);
  border: 1px dashed var(--line); border-radius: 4px; }
details { font-size: 13px; margin-top: 4px; } details details { margin-left: 10px; }
summary { cursor: pointer; }
.lost > summary, .failed b, .unmeasurable b { color: var(--bad); }
.met b { color: var(--good); }
ul { margin: 4px 0; padding-left: 4px; list-style: none; }
li { margin: 2px 0; overflow-wrap: anywhere; }
.lost li { padding-left: 8px; } small { color: var(--faint); }
pre { margin: 4px 0; padding: 8px; max-height: 24em; overflow: auto; background: var(--back);
  border-radius: 4px; font: 12px/1.4 ui-monospace, monospace; white-space: pre-wrap;
  overflow-wrap: anywhere; }
header details { overflow-x: auto; } table { border-collapse: collapse; margin: 8px 0; font-size: 13px; }
th, td { text-align: left; font-weight: normal; padding: 3px 14px 3px 0; border-bottom: 1px solid var(--line);
  white-space: nowrap; }
tr:first-child th { font-weight: 600; }
"""

_SCRIPT = """
const form = document.querySelector("form"), cells = [...document.querySelectorAll("article")];
function choose() {
  const wanted = Object.fromEntries(new FormData(form));
  let seen = 0;
  for (const cell of cells) {
    const { prompt, variant, validity } = cell.dataset;
    const fits = (!wanted.prompt || prompt === wanted.prompt)
      && (!wanted.variant || variant === wanted.variant)
      && (!wanted.validity || validity.split(" ").includes(wanted.validity.replace(/ /g, "-")));
    cell.hidden = !fits;
    seen += fits;
  }
  for (const section of document.querySelectorAll("section"))
    section.hidden = !section.querySelector("article:not([hidden])");
  document.getElementById("count").textContent = seen + " of " + cells.length + " runs";
}
form.addEventListener("input", choose);
choose();
"""
