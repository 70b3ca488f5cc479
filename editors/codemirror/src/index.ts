// AIDL for CodeMirror 6: colours, folding, indentation, brackets, comments, and completion of what needs no server.
import {
  delimitedIndent, foldInside, foldNodeProp, indentNodeProp, LanguageSupport, LRLanguage,
} from "@codemirror/language";
import { completeAidl } from "./complete.js";
import { parser } from "./parser.js";

export { completeAidl } from "./complete.js";

/** The language itself: its parser, and how it is folded and indented. */
export const aidlLanguage = LRLanguage.define({
  name: "aidl",
  parser: parser.configure({
    props: [
      indentNodeProp.add({
        Block: delimitedIndent({ closing: "}" }),
        "ArgumentList ParameterList": delimitedIndent({ closing: ")", align: false }),
        "List Index": delimitedIndent({ closing: "]", align: false }),
      }),
      foldNodeProp.add({
        "Block ArgumentList ParameterList List": foldInside,
        BlockComment: ({ from, to }) => ({ from: from + 2, to: to - 2 }),
      }),
    ],
  }),
  languageData: {
    commentTokens: { line: "//", block: { open: "/*", close: "*/" } },
    closeBrackets: { brackets: ["(", "[", "{", "'", '"'] },
    indentOnInput: /^\s*[\])}]$/,
    autocomplete: completeAidl,
  },
});

/** The extension for an editor. */
export function aidl(): LanguageSupport {
  return new LanguageSupport(aidlLanguage);
}
