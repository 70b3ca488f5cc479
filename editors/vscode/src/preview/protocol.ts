/** What is said between the pane, this extension and the language server: the pane owns the types. */

import type { Status } from "../../../../server/aidl_server/preview/pane/protocol";

export type {
  Applied,
  Ask,
  Element,
  Exported,
  ExportWish,
  Layer,
  Message,
  Name,
  Params,
  Place,
  Position,
  Preview,
  Problem,
  Range,
  Requests,
  Status,
  Tells,
  Told,
} from "../../../../server/aidl_server/preview/pane/protocol";

/** After every run of an open document, whether it is previewed or not. */
export interface RunStatus {
  uri: string;
  version: number;
  status: Status;
  degrees: number | null;
  seconds: number;
  problems: { errors: number; warnings: number };
}
