"""The HTTP client for both SDKs: it neither waits for hours nor repeats requests that were too slow."""

from __future__ import annotations

from typing import Any

import httpx2

from aidl_lang.tools.llm.providers.connection import Connection

_CONNECT = 10.0
_LONGEST_WAIT = 120.0
_AGAIN = "x-should-retry"  # both SDKs obey it
_SILENT = {_AGAIN: "false", "x-aidl-silent": "true"}


class Client(httpx2.Client):
    """A client that does not repeat requests after a timeout, as the SDKs would at a cost and without
    effect.
    """

    def send(self, request: httpx2.Request, **options: Any) -> httpx2.Response:
        try:
            response = super().send(request, **options)
        except httpx2.ReadTimeout:
            return httpx2.Response(408, headers=_SILENT, request=request)
        if not _is_soon(response.headers.get("retry-after", "0")):
            response.headers[_AGAIN] = "false"
        return response

    def __del__(self) -> None:
        """Closes the client, as those do that the SDKs make for themselves."""
        if not self.is_closed:
            self.close()


def options(connection: Connection) -> dict[str, Any]:
    """Returns arguments for the constructor of either SDK's client."""
    timeout = httpx2.Timeout(connection.timeout, connect=min(_CONNECT, connection.timeout))
    client = Client(timeout=timeout, follow_redirects=True)
    return {"timeout": timeout, "max_retries": connection.retries, "http_client": client}


def is_silence(response: httpx2.Response) -> bool:
    """True for a response that stands for none."""
    return "x-aidl-silent" in response.headers


def _is_soon(retry_after: str) -> bool:
    """True for a number of seconds worth waiting for; it may be a date too."""
    try:
        return float(retry_after) <= _LONGEST_WAIT
    except ValueError:
        return False
